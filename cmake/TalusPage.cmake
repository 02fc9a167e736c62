# talus_page(): the page of talus report, one file beside the program: report.html. Its libraries are fetched into the build folder, as page/package-lock.json
# names them; the source folder stays as it is. Where they cannot be fetched the page is left out, and the next build tries again.
function(talus_page)
  find_program(TALUS_NPM npm)
  find_program(TALUS_NODE NAMES node nodejs)
  set(source ${PROJECT_SOURCE_DIR}/page)
  set(work ${PROJECT_BINARY_DIR}/page)
  file(GLOB sources CONFIGURE_DEPENDS ${source}/src/*)
  add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/report.html
    COMMAND ${CMAKE_COMMAND} -D npm=$<IF:$<BOOL:${TALUS_NPM}>,${TALUS_NPM},> -D node=$<IF:$<BOOL:${TALUS_NODE}>,${TALUS_NODE},>
            -D source=${source} -D work=${work} -D page=${PROJECT_BINARY_DIR}/report.html -P ${PROJECT_SOURCE_DIR}/cmake/MakePage.cmake
    DEPENDS ${source}/package.json ${source}/package-lock.json ${source}/.npmrc ${source}/build.mjs ${sources} ${PROJECT_SOURCE_DIR}/cmake/MakePage.cmake
    COMMENT "Page of talus report" VERBATIM)
  add_custom_target(talus_page DEPENDS ${PROJECT_BINARY_DIR}/report.html)
  add_dependencies(programs talus_page)
  if(TARGET talus)
    add_dependencies(talus talus_page)
  endif()
endfunction()

# What the page decodes, and the page in a browser.
function(talus_page_tests)
  if(NOT TALUS_NODE)
    message(STATUS "The tests of the page are left out: they need Node.js")
    return()
  endif()
  add_test(NAME page.offline COMMAND ${TALUS_PYTHON} ${PROJECT_SOURCE_DIR}/page/test/offline_test.py ${CMAKE_COMMAND} ${PROJECT_BINARY_DIR})
  set_tests_properties(page.offline PROPERTIES LABELS unit TIMEOUT 60)
  add_test(NAME page.decode COMMAND ${TALUS_NODE} --test ${PROJECT_SOURCE_DIR}/page/test/decode_test.mjs)
  set_tests_properties(page.decode PROPERTIES LABELS unit TIMEOUT 60)
  if(CMAKE_CXX_FLAGS MATCHES -fsanitize)   # the page is the same in every build
    return()
  endif()
  add_test(NAME page.report COMMAND ${TALUS_NODE} ${PROJECT_SOURCE_DIR}/page/test/report_test.mjs --template ${PROJECT_BINARY_DIR}/report.html)
  set_tests_properties(page.report PROPERTIES SKIP_RETURN_CODE 77 LABELS page TIMEOUT 300 PROCESSORS 2 ENVIRONMENT TALUS_PAGE_MODULES=${PROJECT_BINARY_DIR}/page/node_modules)
endfunction()
