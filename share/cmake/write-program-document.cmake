# SPDX-License-Identifier: BSD-3-Clause
# Writes the output of PROGRAM OPTION to FILE. Compresses it with gzip if FILE ends in .gz, as Debian requires.
cmake_minimum_required(VERSION 3.22)
set(ENV{ASAN_OPTIONS} detect_leaks=0)
string(REGEX REPLACE "\\.gz$" "" plain ${FILE})
execute_process(COMMAND ${PROGRAM} ${OPTION} OUTPUT_FILE ${plain} ERROR_VARIABLE complaint RESULT_VARIABLE failed)
if(failed)
  file(REMOVE ${plain})
  message(FATAL_ERROR "${PROGRAM} ${OPTION} failed with ${failed}: ${complaint}")
endif()
if(NOT plain STREQUAL FILE)
  execute_process(COMMAND gzip --force --best --no-name ${plain} COMMAND_ERROR_IS_FATAL ANY)
endif()
