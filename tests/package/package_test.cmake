# SPDX-License-Identifier: BSD-3-Clause
# Installs a build in a new folder. Compiles each installed header alone, builds the examples against the installed
# files, and runs them.
#
#   cmake -D PSI_SLAM_BUILD=DIR -D WORK=DIR [-D CONFIG=Release] [-D CXX=COMPILER] -P package_test.cmake
cmake_minimum_required(VERSION 3.22)
foreach(name PSI_SLAM_BUILD WORK)
  if(NOT ${name})
    message(FATAL_ERROR "${name} is not set. Usage: cmake -D PSI_SLAM_BUILD=DIR -D WORK=DIR -P package_test.cmake")
  endif()
endforeach()

# run(STEP COMMAND...): runs the command and sets `output` in the caller. Fails with a message that names STEP.
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
# build_project(NAME SOURCE [OPTION...]): builds the project SOURCE in WORK/NAME, as a user would.
function(build_project name source)
  run("configuring ${name}" ${CMAKE_COMMAND} -S ${source} -B ${WORK}/${name}
    -D CMAKE_PREFIX_PATH=${WORK}/installed ${build_type} ${compiler} ${ARGN})
  run("building ${name}" ${CMAKE_COMMAND} --build ${WORK}/${name} ${config})
endfunction()

set(examples ${WORK}/installed/share/doc/libpsi-slam-dev/examples)
build_project(examples ${examples})
build_project(headers ${CMAKE_CURRENT_LIST_DIR} -D HEADERS=${WORK}/installed/include
  -D README=${WORK}/installed/share/doc/psi-slam/README.md)
# The component mapping needs none of these packages.
set(no_more)
foreach(package SQLite3 GDAL OpenCV OpenSSL mrpt-graphslam mrpt-slam)
  list(APPEND no_more -D CMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
build_project(mapping ${CMAKE_CURRENT_LIST_DIR} -D COMPONENTS=mapping
  -D PROGRAM=${examples}/02_feed_scans_one_by_one.cpp ${no_more})
execute_process(COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/wrong -D COMPONENTS=maping
  -D CMAKE_PREFIX_PATH=${WORK}/installed ${compiler} RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE complaint)
if(result EQUAL 0 OR NOT complaint MATCHES "no component \"maping\"")
  message(FATAL_ERROR "a component that does not exist is not reported: ${result} ${complaint}")
endif()

foreach(program psi-slam psi-graphslam)
  run("running the installed ${program}" ${WORK}/installed/bin/${program} --version)
endforeach()
# The installed psi-slam finds its module, and says so if it is missing.
set(read_sensors ${WORK}/installed/bin/psi-slam live --sensors ${WORK}/no_sensors.ini -o ${WORK}/live)
file(WRITE ${WORK}/no_sensors.ini "")
execute_process(COMMAND ${read_sensors} RESULT_VARIABLE result ERROR_VARIABLE complaint)
if(NOT result EQUAL 2 OR NOT complaint MATCHES "no_sensors.ini")
  message(FATAL_ERROR "the installed psi-slam does not read settings of sensors: ${result} ${complaint}")
endif()
file(GLOB_RECURSE module ${WORK}/installed/lib*/psi-slam-sensors.so)
file(REMOVE ${module})
execute_process(COMMAND ${read_sensors} RESULT_VARIABLE result ERROR_VARIABLE complaint)
if(NOT result EQUAL 2 OR NOT complaint MATCHES "cannot load the drivers of sensors from [^ ]*psi-slam-sensors.so")
  message(FATAL_ERROR "a missing module is not reported: ${result} ${complaint}")
endif()

foreach(file man/man1/psi-slam-gui.1.gz man/man5/psi-slam.ini.5.gz bash-completion/completions/psi-slam-bench
    zsh/vendor-completions/_psi-slam psi-slam/ini/psi-slam.ini doc/psi-slam/README.md doc/psi-slam/share/doc/architecture.md)
  if(NOT EXISTS ${WORK}/installed/share/${file})
    message(FATAL_ERROR "share/${file} was not installed")
  endif()
endforeach()

set(rawlog "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog")
if(EXISTS ${rawlog})
  set(pose "-?[0-9.e-]+ -?[0-9.e-]+ -?[0-9.e-]+\n")
  run("running 01_map_a_log" ${WORK}/examples/01_map_a_log ${rawlog} ${WORK}/out)
  if(NOT output MATCHES "\n[0-9]+[.][0-9]+ ${pose}")
    message(FATAL_ERROR "01_map_a_log prints no poses:\n${output}")
  endif()
  run("running 02_feed_scans_one_by_one" ${WORK}/mapping/program ${rawlog} ${WORK}/fed.png)
  if(NOT output MATCHES "^${pose}")
    message(FATAL_ERROR "02_feed_scans_one_by_one prints no poses:\n${output}")
  endif()
  run("running 03_localize" ${WORK}/examples/03_localize ${WORK}/out/map.yaml ${rawlog})
  run("running 04_mrpt_map_builder" ${WORK}/examples/04_mrpt_map_builder ${rawlog} ${WORK}/map.simplemap.gz ${WORK}/map.png)
  if(NOT output MATCHES "[1-9][0-9]* nodes")
    message(FATAL_ERROR "04_mrpt_map_builder maps nothing:\n${output}")
  endif()
  foreach(name out/report.html out/map.png fed.png map.simplemap.gz map.png)
    file(SIZE ${WORK}/${name} size)
    if(size LESS 1000)
      message(FATAL_ERROR "${name} has ${size} bytes, expected at least 1000")
    endif()
  endforeach()
  file(WRITE ${WORK}/wrong.ini "[map]\nresolution = 1\n")
  execute_process(COMMAND ${WORK}/examples/01_map_a_log ${rawlog} ${WORK}/out2 ${WORK}/wrong.ini
    RESULT_VARIABLE result ERROR_VARIABLE complaint)
  if(NOT result EQUAL 1 OR NOT complaint MATCHES "did you mean")
    message(FATAL_ERROR "01_map_a_log does not name the mistake in its settings: ${result} ${complaint}")
  endif()
else()
  message("The rawlog was not mapped, because the data sets of the package mrpt-common are missing")
endif()
file(REMOVE_RECURSE ${WORK})
