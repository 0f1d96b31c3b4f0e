// Every reader on some hundred damaged files: the right data or an InputError of one line, never anything
// else. Runs in normal builds and, where it bites hardest, under the sanitizers.
#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "core/log.h"
#include "fuzz/mutate.h"
#include "fuzz/targets.h"

namespace astrosplat::fuzz {
namespace {

class Replay : public testing::TestWithParam<std::string> {
  protected:
    Replay() {
        set_log_sink([](LogLevel, const std::string&) {});
    }
    ~Replay() override { set_log_sink(nullptr); }
};

TEST_P(Replay, SeedsAreRead) {
    EXPECT_FALSE(target(GetParam()).seeds.empty());
    for (const std::string& seed : target(GetParam()).seeds) EXPECT_GT(target(GetParam()).read(seed), 0u);
}

TEST_P(Replay, DamageIsAnsweredWithOneLine) {
    constexpr std::uint32_t mutations = 600;
    int refused = 0;
    for (const std::string& seed : target(GetParam()).seeds) {
        for (std::uint32_t number = 0; number < mutations; ++number) {
            SCOPED_TRACE("mutation " + std::to_string(number));
            try {
                target(GetParam()).read(mutate(seed, number));
            } catch (const InputError& error) {
                ++refused;
                const std::string line = error.what();
                EXPECT_FALSE(line.empty());
                EXPECT_EQ(line.find('\n'), line.npos) << line;
            } catch (const std::exception& error) {
                ADD_FAILURE() << "not an InputError: " << error.what();
            }
        }
    }
    EXPECT_GT(refused, 0);
}

INSTANTIATE_TEST_SUITE_P(Readers, Replay,
                         testing::Values("pda", "ply", "splats", "obj", "toml", "fits", "stars", "cameras",
                                         "gaussian_ply", "gltf", "usda"),
                         [](const auto& reader) { return reader.param; });

}  // namespace
}  // namespace astrosplat::fuzz
