// Which pixels are visited, and in which order.
#include "image/channels.h"

#include <gmock/gmock.h>

#include <utility>
#include <vector>

namespace astrosplat {
namespace {

using testing::ElementsAre;
using testing::Pair;
using Places = std::vector<std::pair<std::int64_t, std::int64_t>>;

TEST(Channels, APixelsNeighboursAreThoseThatThePictureHas) {
    const Image image = make_image(4, 3, 1);
    Places places;
    const auto note = [&](std::int64_t x, std::int64_t y) { places.emplace_back(x, y); };
    for_each_about(image, 3, 0, 1, note);
    EXPECT_THAT(places, ElementsAre(Pair(2, 0), Pair(3, 0), Pair(2, 1), Pair(3, 1)));
    places.clear();
    for_each_between(image, -5, 2, 0, 9, note);
    EXPECT_THAT(places, ElementsAre(Pair(0, 2)));
    places.clear();
    for_each_between(image, 4, 0, 9, 2, note);
    EXPECT_TRUE(places.empty());
}

TEST(Channels, WithinARadiusArePixelsWhoseMiddlesAre) {
    const Image image = make_image(5, 5, 1);
    Places places;
    double farthest = 0.0;
    for_each_within(image, 2.5, 2.5, 1.0, [&](std::int64_t x, std::int64_t y, double dx, double dy) {
        places.emplace_back(x, y);
        farthest = std::max(farthest, dx * dx + dy * dy);
        EXPECT_EQ(dx, double(x) - 2.0);
        EXPECT_EQ(dy, double(y) - 2.0);
    });
    EXPECT_THAT(places, ElementsAre(Pair(2, 1), Pair(1, 2), Pair(2, 2), Pair(3, 2), Pair(2, 3)));
    EXPECT_EQ(farthest, 1.0);
}

TEST(Channels, EveryPixelIsChangedOnceOnAnyNumberOfThreads) {
    for (const int threads : {1, 3}) {
        set_thread_count(threads);
        Image image = make_image(7, 50, 2, 1.0f);
        change_pixels(image, [](float* p) { p[1] += 2.0f; });
        for_each_pixel(image, [&](std::int64_t x, std::int64_t y) { image.at(x, y)[0] *= 5.0f; });
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            ASSERT_EQ(image.pixels[i], i % 2 == 0 ? 5.0f : 3.0f);
    }
    set_thread_count(0);
}

TEST(Channels, OpaqueLeavesOutWhatIsBehindBlue) {
    Image image = make_image(2, 1, 4, 0.25f);
    const Image opaqued = opaque(image);
    EXPECT_THAT(opaqued.pixels, ElementsAre(0.25f, 0.25f, 0.25f, 1.0f, 0.25f, 0.25f, 0.25f, 1.0f));
}

}  // namespace
}  // namespace astrosplat
