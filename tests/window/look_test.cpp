// A value is dragged, typed, undone and saved.
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

class WindowLook : public WindowTest {};

TEST_F(WindowLook, AValueIsDraggedSavedAndUndone) {
    start();
    const Pixels before = settled_frame();
    person->drag(value_box(power), {60.0f, 0.0f});
    expect_title("scene.toml - edited");
    const Pixels after = settled_frame(before);
    person->press("ctrl+s");
    expect_title("scene.toml");
    EXPECT_GT(saved().layers[0].look.alpha.power, 1.0f);
    const std::string text = text_of(scene_file);
    for (const char* comment : {"# by hand, keep this", "# px", "# the only one"})
        EXPECT_NE(text.find(comment), std::string::npos) << comment;

    person->press("ctrl+z");
    expect_title("scene.toml - edited");
    expect_settled(before);
    person->press("ctrl+shift+z");
    expect_title("scene.toml");
    expect_settled(after);
}

TEST_F(WindowLook, AValueIsTypedAfterADoubleClick) {
    start();
    const Pixels before = settled_frame();
    person->double_click(value_box(power));
    person->type("2.25");
    person->press("Return");
    expect_title("scene.toml - edited");
    settled_frame(before);
    person->press("ctrl+s");
    expect_title("scene.toml");
    EXPECT_EQ(saved().layers[0].look.alpha.power, 2.25f);
}

}  // namespace
}  // namespace astrosplat::test
