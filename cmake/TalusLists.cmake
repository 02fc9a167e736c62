# talus_compile_each(target list text): adds to the target one source for each type of a list of types. The types are those whose headers the
# list includes from its own folder: materials/laws.hpp includes materials/neo_hookean.hpp, which has NeoHookean. `text` is the source, with
# @header@ and @type@. So whoever edits one of them compiles it again, and nobody else's.
function(talus_compile_each target list text)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${list})
  cmake_path(GET list PARENT_PATH folder)
  file(STRINGS ${PROJECT_SOURCE_DIR}/${list} lines REGEX "^#include \"${folder}/")
  foreach(line ${lines})
    string(REGEX REPLACE "^#include \"(.*)\".*" "\\1" header ${line})
    cmake_path(GET header STEM stem)
    string(REPLACE "_" ";" words ${stem})
    set(type "")
    foreach(word ${words})
      string(SUBSTRING ${word} 0 1 first)
      string(SUBSTRING ${word} 1 -1 rest)
      string(TOUPPER ${first} first)
      string(APPEND type ${first}${rest})
    endforeach()
    set(source ${PROJECT_BINARY_DIR}/generated/${folder}/${stem}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "// Written by cmake/TalusLists.cmake.\n#include \"@header@\"\n${text}" @ONLY)
    target_sources(${target} PRIVATE ${source})
    if(NOT CMAKE_UNITY_BUILD)   # as in the preset lint, which reads all sources of a folder at once
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
    if(CMAKE_CXX_FLAGS MATCHES -fsanitize)   # with all calls inlined and each of them checked gcc does not come to an end
      set_property(SOURCE ${source} APPEND PROPERTY COMPILE_OPTIONS -fno-inline)
    endif()
  endforeach()
endfunction()

# Laws behind the interface ConstitutiveLaw.
function(talus_compile_laws target)
  talus_compile_each(${target} materials/laws.hpp [[
#include "materials/interface/varied_law_of.hpp"

namespace talus {

template std::shared_ptr<const ConstitutiveLaw> constitutive_law(const @type@&);
template std::shared_ptr<const VariedLaw> varied_law_of(const @type@&, const std::vector<ParameterVariation>&);
template const LawDescription& law_description<@type@>() noexcept;

}  // namespace talus
]])
endfunction()

# Kernels behind the interface Transfer.
function(talus_compile_kernels target)
  talus_compile_each(${target} kernels/kernels.hpp [[
#include "solver/transfer/transfer_of.hpp"

namespace talus {

template std::unique_ptr<Transfer<2>> make_transfer_of<@type@<2>>(const Mesh<2>&, const Options<@type@<2>>&);
template std::unique_ptr<Transfer<3>> make_transfer_of<@type@<3>>(const Mesh<3>&, const Options<@type@<3>>&);

}  // namespace talus
]])
endfunction()
