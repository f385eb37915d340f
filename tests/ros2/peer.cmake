# SPDX-License-Identifier: BSD-3-Clause
# Builds fastdds_peer where the release has Fast DDS (Debian 12: libfastrtps-dev, Debian 13: libfastdds-dev) and its generator of code,
# which runs in Java.
find_program(PSI_SLAM_FASTDDSGEN fastddsgen)
find_program(PSI_SLAM_JAVA java)
mark_as_advanced(PSI_SLAM_FASTDDSGEN PSI_SLAM_JAVA)
find_package(fastdds 3 QUIET)
if(NOT fastdds_FOUND)
  find_package(fastrtps 2.9 QUIET)
endif()
if(PSI_SLAM_FASTDDSGEN AND PSI_SLAM_JAVA AND (fastdds_FOUND OR fastrtps_FOUND))
  set(peer_folder ${CMAKE_CURRENT_BINARY_DIR}/fastdds_peer_types)
  if(fastdds_FOUND)
    set(peer_library fastdds)
    set(peer_sources ros2_messagesPubSubTypes.cxx ros2_messagesTypeObjectSupport.cxx)
  else()
    set(peer_library fastrtps)
    set(peer_sources ros2_messages.cxx ros2_messagesPubSubTypes.cxx)
  endif()
  list(TRANSFORM peer_sources PREPEND ${peer_folder}/)
  file(MAKE_DIRECTORY ${peer_folder})
  add_custom_command(OUTPUT ${peer_sources}
    COMMAND ${PSI_SLAM_FASTDDSGEN} -replace -d ${peer_folder} ${PROJECT_SOURCE_DIR}/libs/ros2/ros2_messages.idl
    DEPENDS ${PROJECT_SOURCE_DIR}/libs/ros2/ros2_messages.idl WORKING_DIRECTORY ${peer_folder} VERBATIM)
  add_library(fastdds_peer_types STATIC ${peer_sources})
  target_compile_options(fastdds_peer_types PRIVATE -w)  # generated code has warnings
  target_compile_features(fastdds_peer_types PUBLIC cxx_std_17)
  target_include_directories(fastdds_peer_types SYSTEM PUBLIC ${peer_folder})
  target_link_libraries(fastdds_peer_types PUBLIC ${peer_library} fastcdr)
  # Without sanitizers: Fast DDS 2.9 deletes readers and writers with a wrong size.
  add_executable(fastdds_peer ${CMAKE_CURRENT_LIST_DIR}/fastdds_peer.cpp)
  target_link_libraries(fastdds_peer PRIVATE fastdds_peer_types)
endif()
