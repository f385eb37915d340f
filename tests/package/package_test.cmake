# SPDX-License-Identifier: BSD-3-Clause
# Installs a build in a new folder. Builds the project in this folder and the example against the installed files, and runs
# both.
#
#   cmake -D PSI_SLAM_BUILD=DIR -D WORK=DIR [-D CONFIG=Release] [-D CXX=COMPILER] -P package_test.cmake
foreach(name PSI_SLAM_BUILD WORK)
  if(NOT ${name})
    message(FATAL_ERROR "${name} is not set. Usage: cmake -D PSI_SLAM_BUILD=DIR -D WORK=DIR -P package_test.cmake")
  endif()
endforeach()

# run(STEP COMMAND...): runs the command and sets `output` in the caller. Fails with the name STEP.
function(run step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${step} failed with ${result}:\n${out}")
  endif()
  set(output "${out}" PARENT_SCOPE)
endfunction()

set(config)
if(CONFIG)
  set(config --config ${CONFIG})
  set(build_type -D CMAKE_BUILD_TYPE=${CONFIG})
endif()
if(CXX)
  set(compiler -D CMAKE_CXX_COMPILER=${CXX})
endif()

file(REMOVE_RECURSE ${WORK})
run("installing" ${CMAKE_COMMAND} --install ${PSI_SLAM_BUILD} --prefix ${WORK}/installed ${config})
# build_project(NAME SOURCE): builds the project SOURCE in WORK/NAME, as a user would.
function(build_project name source)
  run("configuring ${name}" ${CMAKE_COMMAND} -S ${source} -B ${WORK}/${name}
    -D CMAKE_PREFIX_PATH=${WORK}/installed ${build_type} ${compiler})
  run("building ${name}" ${CMAKE_COMMAND} --build ${WORK}/${name} ${config})
endfunction()

build_project(build ${CMAKE_CURRENT_LIST_DIR})
build_project(example ${WORK}/installed/share/doc/libpsi-slam-dev/examples/map-a-log)

foreach(program psi-slam psi-slam-eval)
  run("running the installed ${program}" ${WORK}/installed/bin/${program} --version)
endforeach()
foreach(file man/man1/psi-slam-gui.1.gz man/man5/psi-slam.ini.5.gz bash-completion/completions/psi-slam-bench
    zsh/vendor-completions/_psi-slam psi-slam/ini/psi-slam.ini doc/psi-slam/README.md doc/psi-slam/share/doc/architecture.md)
  if(NOT EXISTS ${WORK}/installed/share/${file})
    message(FATAL_ERROR "share/${file} was not installed")
  endif()
endforeach()

set(rawlog "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog")
if(EXISTS ${rawlog})
  run("mapping a rawlog" ${WORK}/build/map_rawlog ${rawlog} ${WORK}/map.simplemap.gz ${WORK}/map.png)
  if(NOT output MATCHES "[1-9][0-9]* nodes")
    message(FATAL_ERROR "map_rawlog maps no nodes:\n${output}")
  endif()
  foreach(name map.simplemap.gz map.png)
    file(SIZE ${WORK}/${name} size)
    if(size LESS 1000)
      message(FATAL_ERROR "${name} has ${size} bytes, expected at least 1000")
    endif()
  endforeach()
  run("running the example" ${WORK}/example/map_a_log ${rawlog} map.resolution_m=0.1)
  if(NOT output MATCHES "\n[0-9]+[.][0-9]+ -?[0-9.]+ -?[0-9.]+ -?[0-9.]+\n" OR NOT output MATCHES "225 scans, [1-9][0-9]* nodes")
    message(FATAL_ERROR "the example prints no poses:\n${output}")
  endif()
  execute_process(COMMAND ${WORK}/example/map_a_log ${rawlog} map.resolution=1 RESULT_VARIABLE result ERROR_VARIABLE complaint)
  if(NOT result EQUAL 2 OR NOT complaint MATCHES "did you mean")
    message(FATAL_ERROR "the example does not report a misspelt option: ${result} ${complaint}")
  endif()
else()
  message("The rawlog was not mapped, because the data sets of the package mrpt-common are missing")
endif()
file(REMOVE_RECURSE ${WORK})
