// Small scenes against committed pictures: what nothing else says a frame must look like stays as it was. In:
// scenes/*.toml, one picture each in references/. A picture is judged by three numbers: the difference that
// makes a pixel bad, the share of bad pixels that is allowed, and the difference that no pixel may exceed.
//   A scene without a reference fails, and leaves its picture to be looked at and copied to references/.
#include <iostream>

#include "analytic/support.h"
#include "output/write.h"
#include "scene/load.h"
#include "source/write_image.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Relative to the reference where that is above 1. Half-float files are exact to 5e-4; the frames themselves
// are the same bits everywhere, so more than that is a change of the picture.
constexpr double bad_pixel = 1e-3, bad_share = 0.001, never = 1e-2;

const fs::path folder = fs::path(ASTROSPLAT_SOURCE_DIR) / "tests/images";

std::vector<std::string> scenes() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder / "scenes"))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

/// One channel's distance from its reference.
double difference(float got, float reference) {
    if (!std::isfinite(got) || !std::isfinite(reference)) return std::numeric_limits<double>::infinity();
    return std::fabs(got - reference) / std::max(1.0f, std::fabs(reference));
}

/// Each pixel's largest difference over all channels.
Image differences(const Image& got, const Image& reference) {
    Image result = make_image(got.width, got.height, 1);
    for (std::int64_t y = 0; y < got.height; ++y)
        for (std::int64_t x = 0; x < got.width; ++x)
            for (int c = 0; c < got.channels; ++c)
                *result.at(x, y) =
                    std::max(*result.at(x, y), float(difference(got.at(x, y)[c], reference.at(x, y)[c])));
    return result;
}

/// As a picture to look at: a difference of `never` is white.
void write_differences(const fs::path& file, const Image& differences) {
    std::vector<unsigned char> rgba;
    for (const float d : differences.pixels) {
        const auto level = static_cast<unsigned char>(255.0 * std::min(1.0, d / never));
        rgba.insert(rgba.end(), {level, level, level, 255});
    }
    write_image(file, differences.width, differences.height, rgba);
}

class Images : public testing::TestWithParam<std::string> {
  protected:
    Images() {
        fs::remove_all(output);
        fs::create_directories(output);
    }
    ~Images() override {
        if (!HasFailure()) fs::remove_all(output);
    }

    fs::path output = fs::path(ASTROSPLAT_BINARY_DIR) / "test-output/images" / GetParam();
};

TEST_P(Images, AreThoseOfTheReferences) {
    const Scene scene = load_scene(folder / "scenes" / (GetParam() + ".toml"));
    Pipeline pipeline(scene);
    const fs::path got_file = output / "got.exr",
                   reference_file = folder / "references" / (GetParam() + ".exr");
    const OutputParams& params = scene.output;
    write_frame(
        {got_file, params, params.width, params.height, {}, pipeline.layer_names(pipeline.frame_scene(1.0))},
        analytic::render_frame(pipeline), {});
    ASSERT_TRUE(fs::exists(reference_file))
        << "no reference. Look at " << got_file << ", and when it is right copy it to " << reference_file;

    const analytic::StoredFile got = analytic::read_stored_file(got_file);
    const analytic::StoredFile reference = analytic::read_stored_file(reference_file);
    ASSERT_EQ(got.names, reference.names);
    ASSERT_EQ(got.image.width, reference.image.width);
    ASSERT_EQ(got.image.height, reference.image.height);
    const Image pixels = differences(got.image, reference.image);
    const auto bad =
        std::count_if(pixels.pixels.begin(), pixels.pixels.end(), [](float d) { return d > bad_pixel; });
    EXPECT_LE(double(bad), bad_share * double(pixels.pixels.size()));
    EXPECT_LE(*std::max_element(pixels.pixels.begin(), pixels.pixels.end()), never);
    if (!HasFailure()) return;
    fs::copy_file(reference_file, output / "reference.exr", fs::copy_options::overwrite_existing);
    write_differences(output / "difference.png", pixels);
    std::cout << "got, reference and difference: " << output << "\n";
}

INSTANTIATE_TEST_SUITE_P(Scenes, Images, testing::ValuesIn(scenes()),
                         [](const auto& scene) { return scene.param; });

TEST(References, BelongToAScene) {
    const std::vector<std::string> names = scenes();
    EXPECT_GE(names.size(), 20u);
    std::uintmax_t bytes = 0;
    for (const auto& entry : fs::directory_iterator(folder / "references")) {
        EXPECT_TRUE(std::count(names.begin(), names.end(), entry.path().stem().string())) << entry.path();
        bytes += entry.file_size();
    }
    EXPECT_LT(bytes, 1'000'000u) << "all references together";
}

}  // namespace
}  // namespace astrosplat
