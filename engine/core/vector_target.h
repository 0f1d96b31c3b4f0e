// Which instruction set the vector kernels use. Every target gives the same bits; the switch exists to
// prove that.
#pragma once

#include <string>
#include <vector>

namespace astrosplat {

/// "best" (what the processor offers), or one of vector_targets(). Throws InputError for another name or one
/// this processor lacks. Not while a loop runs.
void set_vector_target(const std::string& name);

/// Chooses what the environment variable ASTROSPLAT_VECTOR_TARGET names, if set; main calls this first.
/// Throws as above.
void use_vector_target_of_environment();

/// The compiled targets this processor can run, best first, from "avx512" "avx2" "sse4" "sse2".
std::vector<std::string> vector_targets();

/// The target in use.
std::string vector_target();

}  // namespace astrosplat
