// Error messages as values, and texts that have a part, for tests that compare them.
#pragma once

#include "core/error.h"

namespace astrosplat {

/// what() of the Error thrown by call(), or "no error".
template <class Error, class Call>
std::string message_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

inline bool has_part(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace astrosplat

/// What the InputError says that the statement throws, or "no error".
#define ERROR_OF(...) ::astrosplat::message_of<::astrosplat::InputError>([&] { __VA_ARGS__; })

/// Shows both where the text has no such part.
#define EXPECT_HAS(text, part) EXPECT_PRED2(::astrosplat::has_part, text, part)
