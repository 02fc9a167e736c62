# talus_compile_laws(target list): adds to the target one source per law, which compiles the law behind the interface ConstitutiveLaw. The laws
# are those whose headers the list (materials/laws.hpp) includes: materials/neo_hookean.hpp has the struct NeoHookean. So whoever edits a law
# compiles its steps again, and nobody else's.
function(talus_compile_laws target list)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${list})
  file(STRINGS ${PROJECT_SOURCE_DIR}/${list} headers REGEX "^#include \"materials/")
  foreach(line ${headers})
    string(REGEX REPLACE "^#include \"(materials/(.*)\\.hpp)\".*" "\\1;\\2" parts ${line})
    list(GET parts 0 header)
    list(GET parts 1 stem)
    string(REPLACE "_" ";" words ${stem})
    set(law "")
    foreach(word ${words})
      string(SUBSTRING ${word} 0 1 first)
      string(SUBSTRING ${word} 1 -1 rest)
      string(TOUPPER ${first} first)
      string(APPEND law ${first}${rest})
    endforeach()
    set(source ${PROJECT_BINARY_DIR}/generated/laws/${stem}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT [[
// Written by cmake/TalusLaws.cmake.
#include "@header@"

#include "materials/interface/constitutive_law_of.hpp"

namespace talus {

template std::shared_ptr<const ConstitutiveLaw> constitutive_law(const @law@&);
template const LawDescription& law_description<@law@>() noexcept;

}  // namespace talus
]] @ONLY)
    target_sources(${target} PRIVATE ${source})
    if(NOT CMAKE_UNITY_BUILD)   # as in the preset lint, which reads all sources of a folder at once
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
    if(CMAKE_CXX_FLAGS MATCHES -fsanitize)   # with all calls inlined and each of them checked gcc does not come to an end
      set_property(SOURCE ${source} APPEND PROPERTY COMPILE_OPTIONS -fno-inline)
    endif()
  endforeach()
endfunction()
