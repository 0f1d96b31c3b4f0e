// Results for a superseded request are dropped, with all that the request held.
#include "viewer/background_work.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

namespace astrosplat {
namespace {

struct Held {
    std::shared_ptr<const int> value;
    bool operator==(const Held&) const = default;
};
struct Sum {
    std::shared_ptr<const int> of;
    std::string error;
};

class LatestWorkTest : public testing::Test {
  protected:
    std::shared_ptr<const Sum> wait_for(const Held& request) {
        work.want(request);
        for (;;) {
            if (auto found = work.found(request)) return found;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    LatestWork<Held, Sum> work{[](const Held& request, const Progress&) { return Sum{request.value, {}}; }};
};

TEST_F(LatestWorkTest, ForgetsWhatItHeld) {
    auto value = std::make_shared<const int>(7);
    const std::weak_ptr<const int> watched = value;
    EXPECT_EQ(*wait_for({value})->of, 7);
    EXPECT_TRUE(work.asked([&](const Held& asked) { return asked.value == value; }));
    value.reset();
    EXPECT_FALSE(watched.expired()) << "else there is nothing to be forgotten";
    work.forget();
    for (int tries = 0; tries < 2000 && !watched.expired(); ++tries)  // the thread may be about to let go
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_TRUE(watched.expired());
    EXPECT_FALSE(work.working());
    EXPECT_FALSE(work.asked([](const Held&) { return true; }));
}

TEST_F(LatestWorkTest, BeginsAgainAfterThat) {
    const Held request{std::make_shared<const int>(3)};
    wait_for(request);
    work.forget();
    EXPECT_EQ(work.found(request), nullptr);
    EXPECT_EQ(*wait_for(request)->of, 3);
}

}  // namespace
}  // namespace astrosplat
