// Error messages as values, for tests that compare them.
#pragma once

#include <exception>
#include <string>

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

}  // namespace astrosplat
