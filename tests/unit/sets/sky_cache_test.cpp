// Skies of one picture are kept beside the sets, to the bit, under a name that everything enters that makes
// them.
#include "sets/kept.h"

#include <gtest/gtest.h>

#include "core/file.h"
#include "core/log.h"
#include "support/starry_picture.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

class KeptSky : public testing::Test {
  protected:
    KeptSky() {
        set_log_sink([this](LogLevel level, const std::string& line) {
            if (level == LogLevel::warning) warnings_.push_back(line);
        });
        folder_.file("p.ppm", picture(120.0));
        cache_.folder = folder_ / "sets";
        tiling_.height_deg = 40.0;
        tiling_.face_px = 32;
    }
    ~KeptSky() override {
        flush_warning_counts();
        set_log_sink(nullptr);
    }
    static std::string picture(double light) {
        return test::starry_pixmap({64, 48, 16, 16, light, 3.0, 0.3, 2.0});
    }
    std::array<Image, 6> sky() const { return kept_skies(cache_)(folder_ / "p.ppm", tiling_, {}); }
    std::array<Image, 6> made() const { return tiled_sky_of(folder_ / "p.ppm", tiling_); }
    bool kept() const { return is_kept(cache_, folder_ / "p.ppm", tiling_); }

    static void expect_same(const std::array<Image, 6>& a, const std::array<Image, 6>& b) {
        for (std::size_t f = 0; f < 6; ++f) {
            EXPECT_EQ(a[f].width, b[f].width);
            EXPECT_EQ(a[f].channels, b[f].channels);
            EXPECT_EQ(a[f].pixels, b[f].pixels) << f;
        }
    }

    TempFolder folder_;
    SetCache cache_;
    SkyTiling tiling_;
    std::vector<std::string> warnings_;
};

TEST_F(KeptSky, IsTheOneThatWasMadeToTheBit) {
    EXPECT_FALSE(kept());
    expect_same(sky(), made());
    EXPECT_TRUE(kept());
    ASSERT_EQ(entries_of(cache_.folder).size(), 1u);
    expect_same(sky(), made());
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(KeptSky, IsReadAndNotMadeAgain) {
    sky();
    const std::vector<fs::path> first = entries_of(cache_.folder);
    SkyTiling other = tiling_;
    other.seed = 2;
    kept_skies(cache_)(folder_ / "p.ppm", other, {});
    std::vector<fs::path> second = entries_of(cache_.folder);
    std::erase(second, first.at(0));
    // Another sky under the first one's name: what is read is what lies there.
    fs::copy_file(second.at(0), first.at(0), fs::copy_options::overwrite_existing);
    expect_same(sky(), tiled_sky_of(folder_ / "p.ppm", other));
}

TEST_F(KeptSky, EverythingThatMakesItIsInItsName) {
    const fs::path file = folder_ / "p.ppm";
    const std::string own = sky_recipe_text(file, tiling_);
    SkyTiling other = tiling_;
    other.seed = 2;
    EXPECT_NE(sky_recipe_text(file, other), own);
    other = tiling_;
    other.height_deg = 41.0;
    EXPECT_NE(sky_recipe_text(file, other), own);
    other = tiling_;
    other.face_px = 64;
    EXPECT_NE(sky_recipe_text(file, other), own);
    folder_.file("q.ppm", picture(120.0));
    EXPECT_EQ(sky_recipe_text(folder_ / "q.ppm", tiling_), own) << "names of files stay out";
    folder_.file("q.ppm", picture(121.0));
    EXPECT_NE(sky_recipe_text(folder_ / "q.ppm", tiling_), own);
    EXPECT_EQ(sky_recipe_text(folder_ / "none.ppm", tiling_), "");
}

TEST_F(KeptSky, ThatIsDamagedIsMadeAgain) {
    sky();
    const fs::path file = entries_of(cache_.folder).at(0);
    fs::resize_file(file, fs::file_size(file) / 2);
    expect_same(sky(), made());
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_[0].find("the sky is made again"), std::string::npos) << warnings_[0];
    expect_same(sky(), made());
    EXPECT_EQ(warnings_.size(), 1u);
}

TEST_F(KeptSky, IsMadeWithoutACache) {
    cache_.folder.clear();
    expect_same(sky(), made());
    EXPECT_FALSE(kept());
    EXPECT_FALSE(fs::exists(folder_ / "sets"));
}

}  // namespace
}  // namespace astrosplat
