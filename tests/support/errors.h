// Error messages as values, texts that have a part, and places that are near, for tests that compare them.
#pragma once

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

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

/// Of points or directions: how far they are apart.
template <class Vector>
void expect_near(const Vector& got, const Vector& expected, double tolerance = 1e-12) {
    testing::Message found;
    for (int i = 0; i < got.length(); ++i) found << got[i] << ' ';
    EXPECT_LT(glm::distance(got, expected), tolerance) << found;
}

}  // namespace astrosplat

/// The message of the InputError that the statement throws, or "no error".
#define ERROR_OF(...) ::astrosplat::message_of<::astrosplat::InputError>([&] { __VA_ARGS__; })

/// Shows both where the text has no such part.
#define EXPECT_HAS(text, part) EXPECT_PRED2(::astrosplat::has_part, text, part)
