# cmake -D npm=... -D node=... -D source=page -D work=... -D page=.../report.html -P MakePage.cmake: the page of talus report. Its libraries are what
# the lock file names, nothing else, fetched once into `work`. Where there is no Node.js, or nothing can be fetched, there is no page afterwards, which
# is said and is no error: everything else of Talus works without it. An older page does not stay: it might not be the one that this program fills.
file(REMOVE ${page})

function(leave_out why)
  message(NOTICE "
  NOTICE: the page of `talus report` and `talus watch` is left out: ${why}
  Everything else is built. With the network within reach, `make build` makes the page; or copy report.html of another build of the same
  commit to ${page}.
")
endfunction()

if(NOT npm OR NOT node)
  leave_out("Node.js 18 or later and npm were not found (on Debian: nodejs, npm).")
  return()
endif()

# What is installed is of this lock file.
file(SHA256 ${source}/package-lock.json wanted)
set(installed)
if(EXISTS ${work}/installed)
  file(READ ${work}/installed installed)
endif()
if(NOT installed STREQUAL wanted)
  file(MAKE_DIRECTORY ${work})
  file(REMOVE ${work}/installed)
  file(COPY ${source}/package.json ${source}/package-lock.json ${source}/.npmrc DESTINATION ${work})
  execute_process(COMMAND ${npm} ci --ignore-scripts --no-audit --no-fund --loglevel=error --fetch-retries=1 --fetch-retry-mintimeout=1000
    WORKING_DIRECTORY ${work} RESULT_VARIABLE failed OUTPUT_VARIABLE words ERROR_VARIABLE words)
  if(failed)
    string(STRIP "${words}" words)
    string(REPLACE "\n" "\n    " words "${words}")
    leave_out("npm could not fetch its libraries, which page/package-lock.json names.\n    ${words}")
    return()
  endif()
  file(WRITE ${work}/installed ${wanted})
endif()

# From here on the network plays no part: what fails is an error.
execute_process(COMMAND ${CMAKE_COMMAND} -E env TALUS_PAGE_MODULES=${work}/node_modules ${node} ${source}/build.mjs ${page} RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "page/build.mjs failed")
endif()
