// Environment variables for the length of a test.
#pragma once

#include <cstdlib>
#include <string>

namespace astrosplat {

/// Sets a variable of the environment, or removes it (null), until the end of its scope.
class Variable {
  public:
    Variable(const char* name, const char* value) : name_(name) {
        if (const char* old = std::getenv(name)) before_ = old, was_set_ = true;
        value ? setenv(name, value, 1) : unsetenv(name);
    }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;
    ~Variable() { was_set_ ? setenv(name_, before_.c_str(), 1) : unsetenv(name_); }

  private:
    const char* name_;
    std::string before_;
    bool was_set_ = false;
};

}  // namespace astrosplat
