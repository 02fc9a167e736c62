#pragma once
// What takes bytes from outside, one function each: libFuzzer calls them (harness.cpp), and so does the test that replays what it has found
// (corpus_test.cpp).  They return where the bytes are good or are refused with a reason; any other exception gets out, a defect.
#include <string_view>

namespace talus {

/// A scene: read, and where it is small its mesh and its formulas.
void fuzz_scene(std::string_view bytes);
/// A mesh file, in 2-D and in 3-D.
void fuzz_msh(std::string_view bytes);
/// A checkpoint: the bytes of the file, or else lines that say how to change a good one (checkpoint_entry.cpp).
void fuzz_checkpoint(std::string_view bytes);

}  // namespace talus
