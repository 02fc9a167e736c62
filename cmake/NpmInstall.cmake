# cmake -D npm=... -D folder=... -P NpmInstall.cmake: what the lock file in the folder names, nothing else; what npm says is told if it fails.
if(NOT npm)
  message(FATAL_ERROR "The page of talus report needs npm, which was not found. `make setup` installs what is missing (on Debian: nodejs, npm).")
endif()
execute_process(COMMAND ${npm} ci --ignore-scripts --no-audit --no-fund --loglevel=error
  WORKING_DIRECTORY ${folder} RESULT_VARIABLE failed OUTPUT_VARIABLE words ERROR_VARIABLE words)
if(failed)
  message(FATAL_ERROR "npm could not fetch the libraries of the page (page/package-lock.json names them and their versions). "
                      "It needs Node 18 or later, and its registry or its cache within reach:\n${words}")
endif()
