# Run at every build (cmake -P): writes the header of core/version.cpp, and touches it only when its text changes.
set(commit "unknown")
find_program(git git)
if(git AND EXISTS ${source_dir}/.git)
  execute_process(COMMAND ${git} --no-optional-locks rev-parse --short=12 HEAD WORKING_DIRECTORY ${source_dir}
                  OUTPUT_VARIABLE head OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
  if(NOT failed)
    execute_process(COMMAND ${git} --no-optional-locks diff-index --quiet HEAD -- WORKING_DIRECTORY ${source_dir}
                    RESULT_VARIABLE changed OUTPUT_QUIET ERROR_QUIET)
    set(commit ${head})
    if(changed)
      string(APPEND commit "-dirty")
    endif()
  endif()
endif()
foreach(name version commit compiler build_type flags)
  string(REPLACE "\\" "\\\\" ${name} "${${name}}")
  string(REPLACE "\"" "\\\"" ${name} "${${name}}")
endforeach()
file(CONFIGURE OUTPUT ${header} @ONLY CONTENT [[
#pragma once
#define TALUS_VERSION "@version@"
#define TALUS_COMMIT "@commit@"
#define TALUS_COMPILER "@compiler@"
#define TALUS_BUILD_TYPE "@build_type@"
#define TALUS_FLAGS "@flags@"
]])
