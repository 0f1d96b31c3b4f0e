// Errors a person can meet. Bad input is one line that names file, place, what was expected and what was
// found; it ends the program with exit code 2. Our own mistakes are asserts, never exceptions.
#pragma once

#include <stdexcept>

#include "core/standard.h"

namespace astrosplat {

/// Bad input: a file, a key or an argument that cannot be used. `what()` is one line, without
/// a trailing newline.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A request that takes more memory than there is (core/memory).
struct NotEnoughMemory : InputError {
    using InputError::InputError;
};

/// An output could not be written (folder read-only, disk full). `what()` is one line.
struct OutputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Work was stopped by a person or a signal; nothing half-done was left behind.
struct Cancelled : std::runtime_error {
    Cancelled() : std::runtime_error("cancelled") {}
};

/// Throws InputError with the line "FILE:PLACE: expected EXPECTED, found FOUND". `place` may be empty (then
/// it is left out, with its colon) or missing; it is usually a line number, "line 12" or a key.
[[noreturn]] void bad_input(const fs::path& file, std::string_view place, std::string_view expected,
                            std::string_view found);
[[noreturn]] void bad_input(const fs::path& file, std::string_view expected, std::string_view found);

}  // namespace astrosplat
