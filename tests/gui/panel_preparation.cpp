// The section Prepare: its rows, before and after with the line between them, and the command of its button.
#include <gtest/gtest.h>

#include "gui/panel_driver.h"
#include "gui/reference_screens.h"

namespace astrosplat {
namespace {

constexpr const char* scene = R"(astrosplat = 1
[[layer]]
name = "dust"
[layer.source]
meshes = [ { mesh = "plane", texture = "dust.png" } ]
prepare = { stars = "remove" }
)";

class PanelPreparation : public testing::Test {
  protected:
    PanelPreparation() {
        driver.status.layers.resize(1);
        driver.status.preparation.emplace();
        driver.status.preparation->before = driver.status.preparation->after = &texture;
        driver.status.preparation->aspect = 1.5f;
        driver.status.preparation->stars = 213;
    }
    glm::vec4 area() const { return driver.panel.plot_area("layer.dust.source.prepare"); }

    Picture8 texture{30, 20};
    PanelDriver driver{scene, 360.0f, 2400.0f};
};

TEST_F(PanelPreparation, ShowsItsRowsAndAsksForAPreviewWhileItIsOpen) {
    driver.view.tab = PanelTab::source;
    driver.frames(2);
    EXPECT_FALSE(driver.view.preparation_open) << "it is folded at first";
    driver.show(PanelTab::source);
    EXPECT_TRUE(driver.view.preparation_open);
    for (const char* key : {"align", "fill", "stars", "threshold", "saturation", "background", "lupton",
                            "ellipse", "mask", "alpha"})
        EXPECT_TRUE(driver.has_row(std::string("layer.dust.source.prepare.") + key)) << key;
    EXPECT_FALSE(driver.has_row("layer.dust.source.prepare.q")) << "it does nothing without lupton";
    driver.show(PanelTab::look);
    driver.frames(2);
    EXPECT_FALSE(driver.view.preparation_open);
}

TEST_F(PanelPreparation, TheLineBetweenBeforeAndAfterIsDragged) {
    driver.show(PanelTab::source);
    const glm::vec4 before = area();
    ASSERT_GT(before.z, 300.0f);
    EXPECT_NEAR(before.w, before.z / 1.5f, 1.5f);
    const auto drawn = [&] {
        Picture8 picture(360, 2400);
        software_draw(*ImGui::GetDrawData(), picture, Style::schematic);
        return picture;
    };
    driver.move({before.x + before.z * 0.5f, before.y + 40.0f});
    driver.frames(3);
    const Picture8 half = drawn();
    driver.drag({before.x + before.z * 0.5f, before.y + 40.0f}, {before.z * 0.25f, 0.0f});
    driver.move({before.x + before.z * 0.5f, before.y + 40.0f});
    driver.frames(3);
    const Picture8 moved = drawn();
    const auto x = static_cast<int>(before.x + before.z * 0.75f), y = static_cast<int>(before.y + 60.0f);
    int differing = 0;
    for (int dx = -2; dx <= 2; ++dx) differing += half.at(x + dx, y) != moved.at(x + dx, y);
    EXPECT_GT(differing, 0) << "the line lies there now";
    EXPECT_EQ(driver.document.edited(), false);
}

TEST_F(PanelPreparation, ItsButtonAsksForTheFolder) {
    driver.show(PanelTab::source);
    const glm::vec4 picture = area();
    // Below the picture: captions, a line of text, the button.
    for (float y = picture.y + picture.w + 24.0f;
         y < picture.y + picture.w + 90.0f && driver.commands.empty(); y += 6.0f)
        driver.click({picture.x + picture.z * 0.5f, y});
    ASSERT_EQ(driver.commands.size(), 1u);
    EXPECT_EQ(driver.commands[0].kind, Command::Kind::prepare_picture);
    EXPECT_EQ(driver.commands[0].index, 0u);
}

TEST_F(PanelPreparation, LooksLikeItsReference) {
    driver.show(PanelTab::source);
    driver.frames(3);
    const glm::vec4 place = area();
    Picture8 picture(360, 2400);
    software_draw(*ImGui::GetDrawData(), picture, Style::schematic);
    expect_like_reference("panel_preparation", cropped(picture, 0, static_cast<int>(place.y) - 330, 360,
                                                       static_cast<int>(place.w) + 420));
}

TEST(PanelPreparationOfSplats, IsNotThere) {
    PanelDriver driver(
        "astrosplat = 1\n[[layer]]\nname = \"a\"\n[layer.source]\nkind = \"splats\"\n"
        "file = \"a.ply\"\n");
    driver.status.layers.resize(1);
    driver.show(PanelTab::source);
    EXPECT_FALSE(driver.view.preparation_open);
}

}  // namespace
}  // namespace astrosplat
