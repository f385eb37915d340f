# SPDX-License-Identifier: BSD-3-Clause
# Installs what find_package(psi-slam COMPONENTS ...) needs: the public headers, the libraries of the components and
# a package file that looks for the dependencies of the requested components only.
include(CMakePackageConfigHelpers)

# The components, and the libraries that each one gives to its users.
set(psi_slam_components mapping logs session localization metric_map_builder graphslam)
set(psi_slam_component_mapping mapping grid_map settings)
set(psi_slam_component_logs logs)
set(psi_slam_component_session session)
set(psi_slam_component_localization localization settings)
set(psi_slam_component_metric_map_builder metric_map_builder settings)
set(psi_slam_component_graphslam graphslam)

# Sets OUTPUT to the CMake command that finds the package of an imported target in another project.
function(psi_slam_command_to_find output target)
  if(target MATCHES "^mrpt::(.*)")
    set(command "find_dependency(mrpt-${CMAKE_MATCH_1} 2.5.8)")
  elseif(target MATCHES "^Eigen3::")
    set(command "find_dependency(Eigen3 3.4 NO_MODULE)")
  elseif(target MATCHES "^opencv_")
    set(command "find_dependency(OpenCV 4.6 COMPONENTS core imgproc imgcodecs)")
  elseif(target MATCHES "^OpenSSL::")
    set(command "find_dependency(OpenSSL 3.0 COMPONENTS Crypto)")
  elseif(target MATCHES "^SQLite::")
    set(command "find_dependency(SQLite3)")
  elseif(target MATCHES "^PkgConfig::(.*)")
    set(library ${CMAKE_MATCH_1})
    set(command "find_dependency(PkgConfig)\n  pkg_check_modules(${library} REQUIRED IMPORTED_TARGET ${library})")
  elseif(target MATCHES "^(Threads|PNG|ZLIB|BZip2|LibLZMA|GDAL)::")
    set(command "find_dependency(${CMAKE_MATCH_1})")
  else()
    message(FATAL_ERROR "An installed library links ${target}: name its package in psi_slam_command_to_find()")
  endif()
  set(${output} "${command}" PARENT_SCOPE)
endfunction()

# Sets two lists to a library's direct dependencies: OWN, targets of this project, and IMPORTED, all others.
function(psi_slam_dependencies_of target)
  set(own)
  set(imported)
  get_target_property(links ${target} LINK_LIBRARIES)
  foreach(link IN LISTS links)
    if(link MATCHES "^psi-slam::(.*)")
      list(APPEND own psi_slam_${CMAKE_MATCH_1})
    elseif(NOT link MATCHES "BUILD_INTERFACE")
      list(APPEND imported ${link})
    endif()
  endforeach()
  set(OWN ${own} PARENT_SCOPE)
  set(IMPORTED ${imported} PARENT_SCOPE)
endfunction()

# Appends a target and its direct and indirect dependencies to the list OUTPUT: dependencies first, each once.
function(psi_slam_append_closure output target)
  if(target IN_LIST ${output})
    return()
  endif()
  psi_slam_dependencies_of(${target})
  foreach(dependency IN LISTS OWN)
    psi_slam_append_closure(${output} ${dependency})
  endforeach()
  set(${output} ${${output}} ${target} PARENT_SCOPE)
endfunction()

# Installs the files that find_package(psi-slam) reads. Defines psi-slam::psi-slam, all components together, in this
# project.
function(psi_slam_install_package)
  set(destination ${CMAKE_INSTALL_LIBDIR}/cmake/psi-slam)
  add_library(psi_slam_all INTERFACE)
  add_library(psi-slam::psi-slam ALIAS psi_slam_all)

  set(libraries)
  set(PSI_SLAM_COMPONENTS)
  foreach(component IN LISTS psi_slam_components)
    list(TRANSFORM psi_slam_component_${component} PREPEND psi_slam_ OUTPUT_VARIABLE given)
    target_link_libraries(psi_slam_all INTERFACE ${given})
    set(needed)
    foreach(target IN LISTS given)
      psi_slam_append_closure(libraries ${target})
      psi_slam_append_closure(needed ${target})
    endforeach()
    list(JOIN psi_slam_component_${component} " " given)
    list(TRANSFORM needed REPLACE "^psi_slam_" "")
    list(JOIN needed " " needed)
    string(APPEND PSI_SLAM_COMPONENTS
      "set(psi_slam_libraries_of_${component} ${given})\nset(psi_slam_closure_of_${component} ${needed})\n")
  endforeach()

  set(PSI_SLAM_LIBRARIES)
  foreach(target IN LISTS libraries)
    string(REPLACE "psi_slam_" "" name ${target})
    string(APPEND PSI_SLAM_LIBRARIES "if(${name} IN_LIST psi_slam_wanted)\n")
    psi_slam_dependencies_of(${target})
    set(commands)
    foreach(link IN LISTS IMPORTED)
      psi_slam_command_to_find(command ${link})
      list(APPEND commands "  ${command}\n")
    endforeach()
    list(REMOVE_DUPLICATES commands)
    list(JOIN commands "" commands)
    string(APPEND PSI_SLAM_LIBRARIES
      "${commands}  include(\"\${CMAKE_CURRENT_LIST_DIR}/psi-slam-${name}-targets.cmake\")\nendif()\n")
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
    install(TARGETS ${target} EXPORT psi-slam-${name} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
    install(EXPORT psi-slam-${name} NAMESPACE psi-slam::internal:: FILE psi-slam-${name}-targets.cmake
      DESTINATION ${destination} COMPONENT development)
  endforeach()

  configure_package_config_file(${PROJECT_SOURCE_DIR}/share/cmake/psi-slam-config.cmake.in
    ${PROJECT_BINARY_DIR}/psi-slam-config.cmake INSTALL_DESTINATION ${destination})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/psi-slam-config-version.cmake
    COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/psi-slam-config.cmake ${PROJECT_BINARY_DIR}/psi-slam-config-version.cmake
    DESTINATION ${destination} COMPONENT development)
  install(DIRECTORY libs/include/ ${PROJECT_BINARY_DIR}/include/
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN "*.h")
  install(DIRECTORY ini/ DESTINATION ${CMAKE_INSTALL_DATADIR}/psi-slam/ini COMPONENT programs)
  install(DIRECTORY share/ros2/ DESTINATION ${CMAKE_INSTALL_DATADIR}/psi-slam/ros2 COMPONENT programs)
endfunction()

# Builds the examples with this project, so that they keep compiling. Their own CMakeLists.txt is for other projects.
function(psi_slam_build_examples)
  file(GLOB examples CONFIGURE_DEPENDS share/examples/*.cpp)
  foreach(example IN LISTS examples)
    get_filename_component(name ${example} NAME_WE)
    add_executable(example_${name} ${example})
    target_link_libraries(example_${name} PRIVATE psi-slam::psi-slam)
    psi_slam_configure_target(example_${name})
  endforeach()
endfunction()
