// A level is dragged: the picture follows at once, without a new set, which comes once the hand rests.
#include <algorithm>

#include "core/atomic_file.h"
#include "gui/theme.h"
#include "sets/kept.h"
#include "support/fits_text.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

const std::string black = "layer.disc.source.black";

class WindowLevels : public WindowTest {
  protected:
    WindowLevels() {
        write_text(folder / "data.fits", fits_file(64, 64, "", [](int x, int y) {
                       return 1.0 + 0.04 * x + (x / 8 + y / 8) % 2 * 1.0;
                   }));
        std::string text = text_of(scene_file);
        const std::string rings = "rings.png", count = "count = 60000";
        text.replace(text.find(rings), rings.size(), "data.fits");
        text.insert(text.find(count), "stretch = \"linear\"\nblack = 2.5\nwhite = 5.0\n");
        write_text(scene_file, text);
    }

    void SetUp() override {
        WindowTest::SetUp();
        if (IsSkipped()) return;
        same_widgets().view.tab = PanelTab::source;
        auto histograms = std::make_shared<LayerHistograms>();
        histograms->values.share.assign(LayerHistograms::bins, 0.5f);
        same_widgets().status.layers[0].histograms = std::move(histograms);
        same_widgets().frame(3);
    }
    /// The tab that is chosen, by the line below its name.
    glm::vec2 chosen_tab() {
        constexpr int least_px = 20;
        const Picture8 picture = same_widgets().picture();
        const auto is_line = [&](int x, int y) {
            const Rgba8& p = picture.at(x, y);
            return IM_COL32(p.r, p.g, p.b, 255) == color::accent;
        };
        for (int y = 40; y < height; ++y)
            for (int x = width * 2 / 3; x + least_px < width; ++x) {
                int length = 0;
                while (length < least_px && is_line(x + length, y)) ++length;
                if (length == least_px) return {x + least_px / 2, y - 12};
            }
        ADD_FAILURE() << "no tab is chosen";
        return {};
    }
    fs::path cache() const { return folder / "home/cache/astrosplat"; }
    std::vector<fs::path> geometries() const {
        std::vector<fs::path> files;
        for (const auto& file : fs::directory_iterator(cache()))
            if (file.path().extension() == ".splats") files.push_back(file.path());
        return files;
    }
    /// Mean of all channels.
    static double brightness(const Pixels& pixels) {
        double sum = 0.0;
        for (const std::uint32_t rgb : pixels.rgb) sum += (rgb >> 16 & 255) + (rgb >> 8 & 255) + (rgb & 255);
        return sum / (3.0 * static_cast<double>(pixels.rgb.size()));
    }
};

// What was too dark to be there comes back, too.
TEST_F(WindowLevels, ADraggedLevelIsSeenWithoutANewSet) {
    start({scene_file.string()});
    const Pixels before = settled_frame();
    person->click(chosen_tab());
    ASSERT_EQ(geometries().size(), 1u);
    {
        // As if another process made it, no set can be made while this is held.
        FileLock held(geometries()[0].replace_extension(".lock"));
        ASSERT_EQ(held.try_lock(), FileLock::State::held);
        person->drag(value_box(black), {-300.0f, 0.0f});
        expect_title("scene.toml - edited");
        EXPECT_TRUE(comes_true([&] { return brightness(frame_pixels()) > 1.2 * brightness(before); }));
        EXPECT_FALSE(settled()) << "what is followed is no final picture";
        person->press("ctrl+z");
        expect_settled(before);
        person->press("ctrl+shift+z");
        EXPECT_TRUE(comes_true([&] { return brightness(frame_pixels()) > 1.2 * brightness(before); }));
    }
    const Pixels after = settled_frame(before);
    EXPECT_GT(brightness(after), 1.2 * brightness(before));
    EXPECT_EQ(geometries().size(), 1u);
    person->press("ctrl+s");
    expect_title("scene.toml");
    EXPECT_LT(saved().layers[0].source.texture.black, 2.0);
    end(SIGTERM);
    start({scene_file.string(), "--no-cache"});  // what --batch and --screenshot draw of the file
    expect_settled(after);
}

}  // namespace
}  // namespace astrosplat::test
