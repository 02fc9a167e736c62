# talus_page(): the page of talus report, one file beside the program: report.html. Its libraries are fetched into the build folder, as page/package-lock.json
# names them; the source folder stays as it is.
function(talus_page)
  find_program(TALUS_NPM npm)
  find_program(TALUS_NODE NAMES node nodejs)
  set(source ${PROJECT_SOURCE_DIR}/page)
  set(work ${PROJECT_BINARY_DIR}/page)
  set(installed ${work}/installed)

  add_custom_command(OUTPUT ${installed}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${work}
    COMMAND ${CMAKE_COMMAND} -E copy_if_different ${source}/package.json ${source}/package-lock.json ${source}/.npmrc ${work}
    COMMAND ${CMAKE_COMMAND} -D npm=$<IF:$<BOOL:${TALUS_NPM}>,${TALUS_NPM},> -D folder=${work} -P ${PROJECT_SOURCE_DIR}/cmake/NpmInstall.cmake
    COMMAND ${CMAKE_COMMAND} -E touch ${installed}
    DEPENDS ${source}/package.json ${source}/package-lock.json ${source}/.npmrc ${PROJECT_SOURCE_DIR}/cmake/NpmInstall.cmake
    COMMENT "Libraries of the page" VERBATIM)

  file(GLOB sources CONFIGURE_DEPENDS ${source}/src/*)
  add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/report.html
    COMMAND ${CMAKE_COMMAND} -E env TALUS_PAGE_MODULES=${work}/node_modules ${TALUS_NODE} ${source}/build.mjs ${PROJECT_BINARY_DIR}/report.html
    DEPENDS ${installed} ${source}/build.mjs ${sources}
    COMMENT "Page of talus report" VERBATIM)
  add_custom_target(talus_page DEPENDS ${PROJECT_BINARY_DIR}/report.html)
  add_dependencies(programs talus_page)
  if(TARGET talus)
    add_dependencies(talus talus_page)
  endif()
endfunction()

# What the page decodes, and the page in a browser.
function(talus_page_tests)
  add_test(NAME page.decode COMMAND ${TALUS_NODE} --test ${PROJECT_SOURCE_DIR}/page/test/decode_test.mjs)
  set_tests_properties(page.decode PROPERTIES LABELS unit TIMEOUT 60)
  if(CMAKE_CXX_FLAGS MATCHES -fsanitize)   # the page is the same in every build
    return()
  endif()
  add_test(NAME page.report COMMAND ${TALUS_NODE} ${PROJECT_SOURCE_DIR}/page/test/report_test.mjs --template ${PROJECT_BINARY_DIR}/report.html)
  set_tests_properties(page.report PROPERTIES LABELS page TIMEOUT 300 PROCESSORS 2 ENVIRONMENT TALUS_PAGE_MODULES=${PROJECT_BINARY_DIR}/page/node_modules)
endfunction()
