// Looking around leaves the scene alone, and a window nobody touches rests.
#include <fstream>
#include <sstream>

#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowView : public WindowTest {};

TEST_F(WindowView, OrbitGoesToAFreeViewAndZeroReturns) {
    start();
    const Pixels before = settled_frame();
    const Pixels tools = pixels_of(&Layout::tools);
    person->drag(same_widgets().at("frame in view"), {120.0f, 40.0f});
    settled_frame(before);
    EXPECT_NE(pixels_of(&Layout::tools), tools) << "the view is still called Camera";
    EXPECT_EQ(title(), "scene.toml - astrosplat") << "looking around is no edit";
    person->press("0");
    expect_settled(before);
    EXPECT_EQ(pixels_of(&Layout::tools), tools);
}

/// User and system time of a process, seconds.
double processor_seconds(pid_t process) {
    std::ifstream in("/proc/" + std::to_string(process) + "/stat");
    std::string text;
    std::getline(in, text);
    std::istringstream fields(text.substr(text.rfind(')') + 2));
    std::string skipped;
    for (int field = 3; field < 14; ++field) fields >> skipped;
    double user = 0.0, system = 0.0;
    fields >> user >> system;
    return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

// Time of the processor, not of the clock: what else the machine does counts little. A window that drew
// frame after frame would need all of it.
TEST_F(WindowView, AnIdleWindowRests) {
    start();
    const Pixels before = settled_frame();
    constexpr double while_s = 3.0, most_s = 0.5;
    const double begin = processor_seconds(program->id());
    usleep(static_cast<useconds_t>(while_s * 1e6));
    const double used = processor_seconds(program->id()) - begin;
    std::printf("idle window: %.1f %% of one core\n", 100.0 * used / while_s);
    EXPECT_LT(used, most_s);
    EXPECT_EQ(frame_pixels(), before);
}

}  // namespace
}  // namespace astrosplat::test
