# SPDX-License-Identifier: BSD-3-Clause
# Builds fastdds_peer where the release has Fast DDS (version 2 is the package fastrtps, version 3 is fastdds) and its generator of code.
find_program(PSI_SLAM_FASTDDSGEN fastddsgen)
find_package(fastdds 3 QUIET)
if(NOT fastdds_FOUND)
  find_package(fastrtps 2.9 QUIET)
endif()
if(PSI_SLAM_FASTDDSGEN AND (fastdds_FOUND OR fastrtps_FOUND))
  set(peer_folder ${CMAKE_CURRENT_BINARY_DIR}/fastdds_peer_messages)
  set(peer_sources ${peer_folder}/ros2_messages.cxx ${peer_folder}/ros2_messagesPubSubTypes.cxx)
  if(fastdds_FOUND)
    # Version 3 describes types in further files.
    list(APPEND peer_sources ${peer_folder}/ros2_messagesTypeObjectSupport.cxx)
    list(REMOVE_ITEM peer_sources ${peer_folder}/ros2_messages.cxx)
  endif()
  add_custom_command(OUTPUT ${peer_sources}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${peer_folder}
    COMMAND ${PSI_SLAM_FASTDDSGEN} -replace -d ${peer_folder} ${PROJECT_SOURCE_DIR}/libs/ros2/ros2_messages.idl
    DEPENDS ${PROJECT_SOURCE_DIR}/libs/ros2/ros2_messages.idl VERBATIM)
  add_executable(fastdds_peer ${CMAKE_CURRENT_LIST_DIR}/fastdds_peer.cpp ${peer_sources})
  target_include_directories(fastdds_peer PRIVATE ${peer_folder})
  target_link_libraries(fastdds_peer PRIVATE $<IF:$<BOOL:${fastdds_FOUND}>,fastdds,fastrtps> fastcdr)
  target_compile_features(fastdds_peer PRIVATE cxx_std_17)
endif()
