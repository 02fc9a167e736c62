# Run when Talus is installed: writes below `to` (share/) what the built `program` says of itself, Debian's change log of `version`, and what the `parts`
# of the build are made of.
find_program(gzip gzip REQUIRED)

function(talus_write_packed file text)
  file(WRITE ${file} "${text}")
  execute_process(COMMAND ${gzip} -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

execute_process(COMMAND ${program} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\\" "\\e" help "${help}")
string(REPLACE "-" "\\-" help "${help}")
string(REGEX REPLACE "(^|\n)([.'])" "\\1\\\\&\\2" help "${help}")
talus_write_packed(${to}/man/man1/talus.1 ".TH TALUS 1 \"\" \"talus ${version}\"
.SH NAME
talus \\- material point method on triangles and tetrahedra
.SH SYNOPSIS
.nf
${help}.fi
.SH SEE ALSO
.BR \"talus info\" ,
.BR \"talus manual\" ,
/usr/share/talus/docs/index.md
")

foreach(shell_and_file "bash;bash-completion/completions/talus" "zsh;zsh/vendor-completions/_talus")
  list(GET shell_and_file 0 shell)
  list(GET shell_and_file 1 file)
  execute_process(COMMAND ${program} completion ${shell} OUTPUT_VARIABLE words RESULT_VARIABLE failed ERROR_QUIET)
  if(NOT failed)   # a program without the command says so
    file(WRITE ${to}/${file} "${words}")
  endif()
endforeach()

# The date is that of the commit: the same sources, the same package.
find_program(git git)
set(date "Thu, 01 Jan 1970 00:00:00 +0000")
if(git AND EXISTS ${source_dir}/.git)
  execute_process(COMMAND ${git} --no-optional-locks log -1 --format=%aD WORKING_DIRECTORY ${source_dir}
                  OUTPUT_VARIABLE told OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
  if(NOT failed)
    set(date "${told}")
  endif()
endif()
talus_write_packed(${to}/doc/talus/changelog "talus (${version}) unstable; urgency=medium

  * What is new for users: /usr/share/talus/CHANGELOG.md

 -- ${maintainer}  ${date}
")

# Which libraries, of which versions: known where Debian's packages are.
find_program(dpkg_query dpkg-query)
find_program(python3 python3 HINTS /usr/bin)
if(dpkg_query AND python3)
  file(MAKE_DIRECTORY ${to}/doc/talus)
  execute_process(COMMAND ${python3} -B ${source_dir}/tools/write_sbom.py ${version} ${to}/doc/talus/sbom.cdx.json ${parts} COMMAND_ERROR_IS_FATAL ANY)
endif()
