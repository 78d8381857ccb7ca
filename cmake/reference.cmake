# The manual page and the completions of bash and zsh, which the program prints from its table of options.

if(NOT TARGET exitance-cli OR EXITANCE_SANITIZE OR EXITANCE_COVERAGE)
    return()
endif()

set(reference_folder ${PROJECT_BINARY_DIR}/reference)
add_custom_command(OUTPUT ${reference_folder}/exitance.1 ${reference_folder}/exitance.bash ${reference_folder}/_exitance
    COMMAND ${CMAKE_COMMAND} -E make_directory ${reference_folder}
    COMMAND exitance-cli reference --format man > ${reference_folder}/exitance.1
    COMMAND exitance-cli reference --format bash > ${reference_folder}/exitance.bash
    COMMAND exitance-cli reference --format zsh > ${reference_folder}/_exitance
    COMMAND gzip -9nkf ${reference_folder}/exitance.1
    DEPENDS exitance-cli VERBATIM)
add_custom_target(exitance-reference ALL
    DEPENDS ${reference_folder}/exitance.1 ${reference_folder}/exitance.bash ${reference_folder}/_exitance)

install(FILES ${reference_folder}/exitance.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)
install(FILES ${reference_folder}/exitance.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
    RENAME exitance OPTIONAL)
install(FILES ${reference_folder}/_exitance DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions OPTIONAL)
