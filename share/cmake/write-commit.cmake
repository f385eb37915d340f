# SPDX-License-Identifier: BSD-3-Clause
# Writes HEADER with the commit that is checked out in SOURCE. Runs at every build and changes the file only if the commit
# changed.
cmake_minimum_required(VERSION 3.22)
find_program(git git)
set(commit "unknown")
if(git)
  execute_process(COMMAND ${git} -C ${SOURCE} rev-parse --short=12 HEAD
    OUTPUT_VARIABLE head OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(commit "${head}")
    execute_process(COMMAND ${git} -C ${SOURCE} status --porcelain --untracked-files=no
      OUTPUT_VARIABLE changes ERROR_QUIET)
    if(changes)
      string(APPEND commit " and changes")
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define PSI_SLAM_COMMIT \"@commit@\"\n" @ONLY)
