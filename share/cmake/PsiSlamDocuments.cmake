# SPDX-License-Identifier: BSD-3-Clause
# Makes and installs man pages and shell completion. The programs print these documents themselves.

# psi_slam_write_document(PROGRAM OPTION FILE)
# Adds a rule that writes the output of PROGRAM OPTION to FILE. Appends FILE to the list `documents` of the caller.
function(psi_slam_write_document program option file)
  set(script ${PROJECT_SOURCE_DIR}/share/cmake/write-program-document.cmake)
  add_custom_command(OUTPUT ${file}
    COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:${program}> -D OPTION=${option} -D FILE=${file} -P ${script}
    DEPENDS ${program} ${script} VERBATIM)
  set(documents ${documents} ${file} PARENT_SCOPE)
endfunction()

# Installs man pages, completion, licence and changelog of all programs made by psi_slam_add_app().
function(psi_slam_install_documents)
  get_property(programs GLOBAL PROPERTY psi_slam_programs)
  set(man ${PROJECT_BINARY_DIR}/man)
  set(completions ${PROJECT_BINARY_DIR}/completions)
  file(MAKE_DIRECTORY ${man} ${completions})
  set(documents)
  foreach(program IN LISTS programs)
    psi_slam_write_document(${program} --man-page ${man}/${program}.1.gz)
    psi_slam_write_document(${program} --bash-completion ${completions}/${program})
    get_target_property(component ${program} PSI_SLAM_COMPONENT)
    install(FILES ${man}/${program}.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
    install(FILES ${completions}/${program}
      DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT ${component})
  endforeach()
  psi_slam_write_document(psi-slam --settings-man-page ${man}/psi-slam.ini.5.gz)
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/ini)
  psi_slam_write_document(psi-slam --dump-config ${PROJECT_BINARY_DIR}/ini/psi-slam.ini)
  add_custom_target(psi_slam_program_documents ALL DEPENDS ${documents})

  list(JOIN programs " " PROGRAMS)
  target_compile_definitions(psi_slam_documents PRIVATE PSI_SLAM_PROGRAMS="${PROGRAMS}")  # for the section SEE ALSO
  configure_file(${PROJECT_SOURCE_DIR}/share/cmake/zsh-completion.in ${PROJECT_BINARY_DIR}/_psi-slam @ONLY)

  install(FILES ${PROJECT_BINARY_DIR}/ini/psi-slam.ini DESTINATION ${CMAKE_INSTALL_DATADIR}/psi-slam/ini
    COMPONENT programs)
  install(FILES ${man}/psi-slam.ini.5.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man5 COMPONENT programs)
  install(FILES ${PROJECT_BINARY_DIR}/_psi-slam
    DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT programs)
  install(FILES README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/psi-slam COMPONENT programs)
  install(DIRECTORY share/doc/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/psi-slam/share/doc COMPONENT programs)
  install(DIRECTORY share/examples
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libpsi-slam-dev COMPONENT development PATTERN python EXCLUDE)
  if(TARGET psi_slam_python)
    install(DIRECTORY share/examples/python/
      DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-psi-slam/examples COMPONENT python FILES_MATCHING PATTERN "*.py")
  endif()
  psi_slam_list_packages(packages)
  foreach(package IN LISTS packages)
    psi_slam_component_of(component ${package})
    psi_slam_install_legal_documents(${package} ${component})
  endforeach()
endfunction()

# Sets OUTPUT to the names of all Debian packages that this build gives.
function(psi_slam_list_packages output)
  set(packages psi-slam psi-slam-bench libpsi-slam-dev)
  if(TARGET psi_slam_python)
    list(APPEND packages python3-psi-slam)
  endif()
  set(${output} ${packages} PARENT_SCOPE)
endfunction()

# Sets OUTPUT to the component that the package contains.
function(psi_slam_component_of output package)
  set(psi-slam programs)
  set(psi-slam-bench bench)
  set(libpsi-slam-dev development)
  set(python3-psi-slam python)
  set(${output} ${${package}} PARENT_SCOPE)
endfunction()

# Installs the licence and the changelog that every Debian package must contain.
function(psi_slam_install_legal_documents package component)
  set(folder ${CMAKE_INSTALL_DATADIR}/doc/${package})
  set(changelog ${PROJECT_BINARY_DIR}/changelog.gz)
  if(NOT TARGET psi_slam_changelog)
    add_custom_command(OUTPUT ${changelog} DEPENDS ${PROJECT_SOURCE_DIR}/CHANGELOG.md VERBATIM
      COMMAND ${CMAKE_COMMAND} -E copy ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_BINARY_DIR}/changelog
      COMMAND gzip --force --best --no-name ${PROJECT_BINARY_DIR}/changelog)
    add_custom_target(psi_slam_changelog ALL DEPENDS ${changelog})
  endif()
  install(FILES ${changelog} DESTINATION ${folder} COMPONENT ${component})
  install(FILES LICENSE DESTINATION ${folder} RENAME copyright COMPONENT ${component})
endfunction()
