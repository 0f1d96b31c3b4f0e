// Tests that need OpenGL: one context without a window for all of them, or a message why they are skipped.
#pragma once

#include "gl/objects.h"
#include "support/test.h"

namespace astrosplat::test {

/// The program's only context; null where none can be had, with the reason.
struct SharedContext {
    std::unique_ptr<OffscreenContext> context;
    std::string reason;
};
inline SharedContext& shared_context() {
    static SharedContext shared = [] {
        SharedContext made;
        try {
            made.context = std::make_unique<OffscreenContext>();
        } catch (const std::runtime_error& error) {
            made.reason = error.what();
        }
        return made;
    }();
    return shared;
}

class GlTest : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!shared_context().context) GTEST_SKIP() << shared_context().reason;
    }
};

}  // namespace astrosplat::test
