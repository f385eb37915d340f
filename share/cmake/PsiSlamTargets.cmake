# SPDX-License-Identifier: BSD-3-Clause
# Functions that make the targets of the project, one for each kind of target. All targets share language level, warnings,
# layout and installation.
include(GNUInstallDirs)

# Sets language level, strict warnings and sanitizers of a target.
function(psi_slam_configure_target target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  # Without contraction to fused multiply-add, every machine rounds each expression in the same way.
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast
    -Wcast-align -Woverloaded-virtual -Wdouble-promotion -Wformat=2 -Wimplicit-fallthrough
    -ffp-contract=off)
  if(PSI_SLAM_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(PSI_SLAM_SANITIZE)
    # MRPT's libraries lack the type information that the check of virtual calls needs. Its headers state alignments of boxes and
    # of drawn objects that it does not keep. With sanitizers, GCC falsely reports uninitialised values in std::regex.
    set(sanitizers -fsanitize=address,undefined -fno-sanitize=vptr,alignment -fno-sanitize-recover=undefined)
    target_compile_options(${target} PRIVATE ${sanitizers} -fno-omit-frame-pointer
      $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
  endif()
  if(PSI_SLAM_FUZZ)
    # MRPT's libraries lack the type information that the check of virtual calls needs.
    set(sanitizers -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize=vptr -fno-sanitize-recover=undefined)
    target_compile_options(${target} PRIVATE ${sanitizers} -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=address,undefined -fno-sanitize=vptr)
  endif()
  if(PSI_SLAM_SANITIZE_THREADS)
    target_compile_options(${target} PRIVATE -fsanitize=thread -fno-omit-frame-pointer
      $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
    target_link_options(${target} PUBLIC -fsanitize=thread)
  endif()
endfunction()

# psi_slam_join_sources(COUNT TARGET...)
# Compiles COUNT sources at a time. This saves more than half of the time if COUNT is 16: the sources instantiate the same templates.
# Two sources of such a target must not define the same name in an unnamed namespace.
function(psi_slam_join_sources count)
  set_target_properties(${ARGN} PROPERTIES UNITY_BUILD ${PSI_SLAM_JOIN_SOURCES} UNITY_BUILD_BATCH_SIZE ${count})
endfunction()

# psi_slam_add_library(NAME [LIGHT] SOURCES file... [PUBLIC dependency...] [PRIVATE dependency...])
# Adds a static library as psi-slam::NAME. Its own headers lie beside its sources and are included by their path below
# libs/; the public headers of all libraries are libs/include/psi_slam/*.h. The library is installed if a
# component of the package needs it, see PsiSlamInstallation.cmake. LIGHT: see psi_slam_configure_light_target().
function(psi_slam_add_library name)
  cmake_parse_arguments(ARG "LIGHT" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target psi_slam_${name})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(psi-slam::${name} ALIAS ${target})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${psi-slam_SOURCE_DIR}/libs> $<BUILD_INTERFACE:${psi-slam_SOURCE_DIR}/libs/include>
    $<BUILD_INTERFACE:${psi-slam_BINARY_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC})
  foreach(dependency IN LISTS ARG_PRIVATE)
    if(dependency MATCHES "^nlohmann_json::")  # header-only: users of the static library do not need it
      set(dependency $<BUILD_INTERFACE:${dependency}>)
    endif()
    target_link_libraries(${target} PRIVATE ${dependency})
  endforeach()
  if(ARG_LIGHT)
    psi_slam_configure_light_target(${target})
  else()
    psi_slam_configure_target(${target})
  endif()
endfunction()

# psi_slam_add_app(NAME [COMPONENT component] SOURCES file... LINK dependency...)
# Adds a program and installs it with its man page and completion. The program must have the options of
# add_document_options(). It belongs to the component `programs` unless COMPONENT names another one.
function(psi_slam_add_app name)
  cmake_parse_arguments(ARG "" "COMPONENT" "SOURCES;LINK" ${ARGN})
  if(NOT ARG_COMPONENT)
    set(ARG_COMPONENT programs)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINK})
  psi_slam_configure_target(${name})
  set_property(GLOBAL APPEND PROPERTY psi_slam_programs ${name})
  set_target_properties(${name} PROPERTIES PSI_SLAM_COMPONENT ${ARG_COMPONENT})
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${ARG_COMPONENT})
endfunction()

# Sets the compiler options of code that only reads options, writes reports, starts runs, shows windows or tests libraries. Little
# optimisation is enough for it, and it compiles faster. But it makes false warnings of uninitialised values.
function(psi_slam_configure_light_target target)
  psi_slam_configure_target(${target})
  target_compile_options(${target} PRIVATE
    $<$<CONFIG:Release>:-O1> $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>>:-Wno-maybe-uninitialized>)
endfunction()

# psi_slam_add_tests(FOLDER [SEPARATE] [LOCK resource] LINK dependency...)
# Adds one program NAME_tests with all tests/FOLDER/*_test.cpp, see psi_slam_add_test_suites(). NAME is the last part of FOLDER.
# SEPARATE compiles each source alone. Suites with the same LOCK do not run at the same time.
function(psi_slam_add_tests folder)
  cmake_parse_arguments(ARG "SEPARATE" "LOCK" "LINK" ${ARGN})
  get_filename_component(name ${folder} NAME)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*_test.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(${name}_tests ${sources})
  target_link_libraries(${name}_tests PRIVATE ${ARG_LINK} psi_slam_test_support GTest::gmock_main)
  psi_slam_configure_light_target(${name}_tests)
  if(NOT ARG_SEPARATE)
    psi_slam_join_sources(4 ${name}_tests)
  endif()
  if(TARGET psi_slam_test_headers)
    target_precompile_headers(${name}_tests REUSE_FROM psi_slam_test_headers)
  endif()
  set(timeout_s 900)
  if(PSI_SLAM_SANITIZE OR PSI_SLAM_SANITIZE_THREADS)
    set(timeout_s 3600)
  endif()
  set(lock)
  if(ARG_LOCK)
    set(lock RESOURCE_LOCK ${ARG_LOCK})
  endif()
  psi_slam_add_test_suites(${name} TIMEOUT ${timeout_s} ${lock})
endfunction()

# psi_slam_add_test_suites(NAME PROPERTY VALUE...)
# CTest runs each suite of the program NAME_tests as the test NAME.Suite, with these properties.
function(psi_slam_add_test_suites name)
  set(tests ${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake)
  # The presets set the same options of sanitizers for the tests.
  add_custom_command(TARGET ${name}_tests POST_BUILD BYPRODUCTS ${tests}
    COMMAND ${CMAKE_COMMAND} -E env ASAN_OPTIONS=detect_leaks=0
      TSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/thread-sanitizer.supp
      ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:${name}_tests> -D PREFIX=${name} -D "PROPERTIES=${ARGN}"
      -D RESULTS=${PROJECT_BINARY_DIR}/test-results -D OUTPUT=${tests}
      -P ${PROJECT_SOURCE_DIR}/share/cmake/write-test-suites.cmake
    VERBATIM)
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/${name}_tests.cmake
    "if(EXISTS [==[${tests}]==])\n  include([==[${tests}]==])\nelse()\n  add_test(${name}_NOT_BUILT ${name}_NOT_BUILT)\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}_tests.cmake)
endfunction()
