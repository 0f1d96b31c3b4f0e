// Figures of layers and of differences, thumbnails, references, and the layer that a click selects.
#include "core/color.h"
#include "support/splats.h"
#include "support/test.h"
#include "viewer/comparison.h"
#include "viewer/loaded_layer.h"
#include "viewer/preview_splats.h"

namespace astrosplat {
namespace {

// Pictures beside the frame: differences, thumbnails and references.

// Numbers of a difference, and thumbnails of snapshots, that can be worked out by hand.

TEST(DifferenceMeter, EvenPicturesDifferByTheirValues) {
    const Image a = make_image(5, 4, 4, 0.6f), b = make_image(5, 4, 4, 1.0f);
    Image half = b;
    for (std::size_t i = 0; i < half.pixels.size(); ++i)
        if (i % 4 != 3) half.pixels[i] = 0.5f;
    const auto found = difference_of(a, half);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->mean, 0.1, 1e-6);
    EXPECT_NEAR(found->psnr_db, 20.0, 1e-4);
    EXPECT_NEAR(found->light, real::srgb_to_linear(0.6) / real::srgb_to_linear(0.5), 1e-5);
}

TEST(DifferenceMeter, SignsCancelInTheMeanOnly) {
    Image a = make_image(2, 1, 4, 0.5f), b = make_image(2, 1, 4, 0.5f);
    a.at(0, 0)[1] = 0.7f;
    a.at(1, 0)[1] = 0.3f;
    b.at(0, 0)[3] = b.at(1, 0)[3] = 1.0f;
    const auto found = difference_of(a, b);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->mean, 0.0, 1e-7);
    EXPECT_NEAR(found->psnr_db, -10.0 * std::log10(0.04 / 3.0), 1e-4);
}

TEST(DifferenceMeter, OnlyWhereBothAreSeen) {
    const Image a = make_image(3, 1, 4, 0.25f);
    Image b = make_image(3, 1, 4, 0.0f);
    EXPECT_FALSE(difference_of(a, b));
    for (int c = 0; c < 4; ++c) b.at(1, 0)[c] = c == 3 ? 1.0f : 0.25f;
    const auto found = difference_of(a, b);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->mean, 0.0);
    EXPECT_TRUE(std::isinf(found->psnr_db));
    EXPECT_EQ(found->light, 1.0);
}

TEST(DifferenceMeter, BlackAgainstBlackHasTheSameLight) {
    Image a = make_image(1, 1, 4, 0.0f), b = a;
    b.at(0, 0)[3] = 1.0f;
    EXPECT_EQ(difference_of(a, b)->light, 1.0);
    a.at(0, 0)[0] = 0.5f;
    EXPECT_TRUE(std::isinf(difference_of(a, b)->light));
}

TEST(Thumbnail, AveragesBoxes) {
    // 4 x 3 px into boxes of 2 x 2; the row that is left over is dropped.
    std::vector<unsigned char> rgba;
    for (int i = 0; i < 12; ++i)
        for (int c = 0; c < 4; ++c) rgba.push_back(static_cast<unsigned char>(c == 3 ? 255 : 10 * i + c));
    const Image small = thumbnail_of(rgba, 4, 3, 2);
    ASSERT_EQ(small.width, 2);
    ASSERT_EQ(small.height, 1);
    for (int c = 0; c < 3; ++c) {
        EXPECT_FLOAT_EQ(small.at(0, 0)[c], (25.0f + float(c)) / 255.0f);
        EXPECT_FLOAT_EQ(small.at(1, 0)[c], (45.0f + float(c)) / 255.0f);
    }
    EXPECT_EQ(small.at(1, 0)[3], 1.0f);
    EXPECT_EQ(thumbnail_of(rgba, 4, 3, 8).width, 4) << "small pictures stay as they are";
    const Image low = thumbnail_of(std::vector<unsigned char>(8 * 4, 51), 8, 1, 2);  // blocks of 4 x 1 px
    EXPECT_EQ(low.width, 2);
    EXPECT_EQ(low.height, 1);
    EXPECT_FLOAT_EQ(low.at(1, 0)[0], 0.2f);
}

// Results of registration as the placement of a reference over a frame.

/// Three blobs that make no symmetric figure, on a picture of this size.
Image blobs(std::int64_t width, std::int64_t height) {
    Image image = make_image(width, height, 4, 1.0f);
    const double h = double(height);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            double light = 0.0;
            for (const glm::dvec3& blob : {glm::dvec3(0.5, 0.5, 0.12), {0.8, 0.4, 0.06}, {0.4, 0.8, 0.08}}) {
                const double r =
                    glm::distance(glm::dvec2(double(x), double(y)) / h, glm::dvec2(blob)) / blob.z;
                light += 0.6 * std::exp(-r * r);
            }
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = float(light * (1.0 - 0.2 * c));
        }
    return image;
}

/// A view that shows the picture where `placed` puts it.
Image view_of(const Image& picture, const ReferenceParams& placed, const FrameOnScreen& frame, int width,
              int height) {
    const PicturePlace place = place_of(placed, double(picture.width) / double(picture.height), frame);
    Image view = make_image(width, height, 4, 0.0f);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            const glm::dvec2 from = glm::dvec2(double(x) + 0.5, double(y) + 0.5) - place.corner;
            const double u = glm::dot(from, place.right) / glm::dot(place.right, place.right);
            const double v = glm::dot(from, place.down) / glm::dot(place.down, place.down);
            if (u < 0.0 || v < 0.0 || u >= 1.0 || v >= 1.0) continue;
            const auto px = std::int64_t(u * double(picture.width));
            const auto py = std::int64_t(v * double(picture.height));
            std::copy_n(picture.at(px, py), 4, view.at(x, y));
        }
    return view;
}

TEST(ReferenceAlignment, FindsThePlacementThatMadeTheView) {
    AlignmentRequest request;
    request.picture = blobs(300, 200);
    request.frame = {{210.0, 140.0}, 240.0};  // the view is a part of it
    for (const bool mirrored : {false, true}) {
        ReferenceParams placed;
        placed.file = "blobs.png";
        placed.mirrored = mirrored;
        request.reference = placed;
        placed.position = {0.1, -0.05};
        placed.scale = 0.8;
        placed.rotate = 25.0;
        request.view = view_of(request.picture, placed, request.frame, 400, 260);
        const AlignmentFound found = align_reference(request);
        ASSERT_TRUE(found.reference);
        EXPECT_EQ(found.reference->file, "blobs.png");
        EXPECT_EQ(found.reference->mirrored, mirrored);
        EXPECT_NEAR(found.reference->position.x, 0.1, 1.0 / 240.0);
        EXPECT_NEAR(found.reference->position.y, -0.05, 1.0 / 240.0);
        EXPECT_NEAR(found.reference->scale, 0.8, 0.004);
        EXPECT_NEAR(found.reference->rotate, 25.0, 0.3);
    }
}

TEST(ReferenceAlignment, AnEmptyViewHasNone) {
    AlignmentRequest request;
    request.picture = blobs(300, 200);
    request.frame = {{200.0, 120.0}, 240.0};
    request.view = make_image(400, 240, 4, 0.0f);
    EXPECT_FALSE(align_reference(request).reference);
}

// Figures of a layer in the controls: histograms of its distances and of its picture's values,
// its mean colour.

SplatSet set_of(const std::vector<float>& distances) {
    SplatSet set;
    for (const float distance : distances) {
        add_splat(set, glm::vec3(0.0f), glm::vec3(1.0f), 1.0f);
        set.distance.back() = distance;
    }
    return set;
}

TEST(Histograms, OfDistancesReachToTheLargest) {
    SplatSet set = set_of({0.0f, 0.9f, 1.0f, 63.5f, 64.0f, 65.0f, -0.5f});
    set.distance.push_back(std::numeric_limits<float>::quiet_NaN());
    set.max_distance = 64.0;
    const LayerHistograms found = histograms(set, {});
    EXPECT_EQ(found.max_distance, 64.0);
    for (int i = 0; i < LayerHistograms::bins; ++i)
        EXPECT_EQ(found.distance[std::size_t(i)], i == 0 || i == 63 ? 1.0f : i == 1 ? 0.5f : 0.0f) << i;
    EXPECT_TRUE(found.values.share.empty());
}

TEST(Histograms, WithoutDistancesAreEmpty) {
    const LayerHistograms found = histograms(set_of({}), {});
    for (const float share : found.distance) EXPECT_EQ(share, 0.0f);
}

TEST(Histograms, OfAPictureAreOfItsLargestChannel) {
    const TempFolder folder;
    SourceParams source;
    // 255, 255, 128 and 0 of 255 in one channel, less in the others.
    source.meshes = {{"plane",
                      {folder.file("a.ppm", std::string("P6\n2 2\n255\n\xff\x10\x20\x01\xff\x02"
                                                        "\x80\x7f\x01\x00\x00\x00",
                                                        11 + 12))}}};
    const LayerHistograms found = histograms(set_of({}), source);
    ASSERT_EQ(found.values.share.size(), std::size_t{LayerHistograms::bins});
    EXPECT_EQ(found.values.lo, 0.0);
    EXPECT_EQ(found.values.hi, 1.0);
    for (std::size_t i = 0; i < found.values.share.size(); ++i)
        EXPECT_EQ(found.values.share[i], i == 63 ? 1.0f : i == 0 || i == 32 ? 0.5f : 0.0f) << i;
}

/// Weighted by alpha, of a few thousand splats at most.
TEST(MeanColor, IsOfSplatsFromEverywhere) {
    SplatSet set = set_of(std::vector<float>(16384, 0.0f));
    for (std::size_t i = 0; i < 16384; ++i) {
        const bool first = i < 8192;
        set.color[i] = glm::vec3(first ? 1.0f : 0.25f);
        set.alpha[i] = first ? 0.5f : 1.0f;
    }
    EXPECT_EQ(sampled_layer({set, 1}, {}, "a").color, glm::vec3(0.5f));
    EXPECT_EQ(sampled_layer({set_of({}), 1}, {}, "a").color, glm::vec3(1.0f));
}

// Which layer a click in the picture selects: the brightest at that pixel first, dust by what it hides.

constexpr std::int64_t size = 64;  // px

/// Layers of one large splat each, seen from +z; x < 0 is the left half.
struct LayersAtPixel : testing::Test {
    std::vector<ShadedSplats> splats;
    std::vector<PreviewLayer> layers;
    LayersAtPixel() { splats.reserve(8); }

    PreviewLayer& add(const char* name, glm::vec3 place, glm::vec3 color, float alpha = 1.0f) {
        ShadedSplats splat;
        splat.position.push_back(place);
        splat.color.push_back(color);
        splat.alpha.push_back(alpha);
        splat.radius.push_back(1.0f);
        splat.id.push_back(splats.size());
        splats.push_back(std::move(splat));
        PreviewLayer layer;
        layer.layer.name = name;
        layer.layer.splats = &splats.back();
        layer.layer.render.falloff.shape = Falloff::Shape::constant;
        layers.push_back(std::move(layer));
        return layers.back();
    }
    static PreviewView view() {
        PreviewView view;
        CameraParams params;
        params.projection = Projection::orthographic;
        params.position = glm::dvec3(0.0, 0.0, 10.0);
        params.height = 4.0;
        view.width = view.height = size;
        view.camera = make_camera(params, double(size), double(size), {});
        return view;
    }
    std::vector<float> light(std::int64_t x, std::int64_t y) const {
        return light_of_layers(layers, view(), x, y);
    }
    std::vector<std::size_t> seen(std::int64_t x, std::int64_t y) const { return seen_layers(light(x, y)); }
};

TEST_F(LayersAtPixel, EachLayerIsFoundWhereItIs) {
    add("left", {-1.0f, 0.0f, 0.0f}, glm::vec3(0.2f));
    add("right", {1.0f, 0.0f, 0.0f}, glm::vec3(0.8f));
    EXPECT_EQ(seen(16, 32), std::vector<std::size_t>{0});
    EXPECT_EQ(seen(48, 32), std::vector<std::size_t>{1});
    EXPECT_EQ(seen(16, 4), std::vector<std::size_t>{});
}

TEST_F(LayersAtPixel, LightIsThatOfNinePixelsAsItArrives) {
    add("behind", {0.0f, 0.0f, -1.0f}, {0.25f, 0.5f, 0.25f});
    add("in front", {0.0f, 0.0f, 1.0f}, {0.5f, 0.0f, 0.5f}, 0.75f);
    const std::vector<float> found = light(32, 32);
    EXPECT_NEAR(found[0], 9.0f * 0.25f, 1e-4f);
    EXPECT_NEAR(found[1], 9.0f * 0.75f, 1e-4f);
    EXPECT_EQ(seen(32, 32), (std::vector<std::size_t>{1, 0}));
}

TEST_F(LayersAtPixel, WhatHidesIsSeenByTheLightItTakes) {
    add("stars", {0.0f, 0.0f, -1.0f}, glm::vec3(1.0f));
    add("dust", {0.0f, 0.0f, 1.0f}, glm::vec3(1.0f), 0.75f).layer.render.blend = Blend::absorb;
    layers[1].layer.render.absorb = glm::vec3(1.0f);
    const std::vector<float> found = light(32, 32);
    EXPECT_NEAR(found[0], 9.0f * 3.0f * 0.25f, 1e-3f);
    EXPECT_NEAR(found[1], 9.0f * 3.0f * 0.75f, 1e-3f);
    EXPECT_EQ(seen(32, 32), (std::vector<std::size_t>{1, 0}));
}

TEST_F(LayersAtPixel, NothingIsSeenOutsideTheFrame) {
    add("all", {0.0f, 0.0f, 0.0f}, glm::vec3(1.0f));
    for (const auto& [x, y] : {std::pair{-1, 32}, {64, 32}, {32, -1}, {32, 64}})
        EXPECT_EQ(light(x, y), std::vector<float>{0.0f}) << x << " " << y;
    EXPECT_GT(light(32, 32)[0], 0.0f);
}

/// Scene units from the camera, between 0 and 20 of them.
std::optional<double> depth_of(const LayersAtPixel& seen, const PreviewView& view, std::int64_t x,
                               std::int64_t y) {
    return depth_at(seen.layers, view, 0.0, 20.0, x, y);
}

TEST_F(LayersAtPixel, DepthIsThatOfHalfOfWhatCovers) {
    constexpr double exact = 20.0 / 1024.0;
    add("behind", {0.0f, 0.0f, -1.0f}, glm::vec3(0.5f));
    add("in front", {0.0f, 0.0f, 1.0f}, glm::vec3(0.5f), 0.75f);
    EXPECT_NEAR(depth_of(*this, view(), 32, 32).value(), 9.0, exact);
    splats[1].alpha[0] = 0.25f;
    EXPECT_NEAR(depth_of(*this, view(), 32, 32).value(), 11.0, exact);
    PreviewView near = view();
    near.camera.far = 10.0;
    EXPECT_NEAR(depth_of(*this, near, 32, 32).value(), 9.0, exact) << "the other is too far to be seen";
    EXPECT_FALSE(depth_of(*this, view(), 2, 2));
    EXPECT_FALSE(depth_of(*this, view(), 64, 32));
    EXPECT_FALSE(depth_of(*this, view(), 32, -1));
}

TEST_F(LayersAtPixel, DepthOfLightIsThatOfHalfOfIt) {
    constexpr double exact = 20.0 / 1024.0;
    add("behind", {0.0f, 0.0f, -1.0f}, glm::vec3(0.5f)).layer.render.blend = Blend::add;
    add("in front", {0.0f, 0.0f, 1.0f}, glm::vec3(0.1f)).layer.render.blend = Blend::add;
    EXPECT_NEAR(depth_of(*this, view(), 32, 32).value(), 11.0, exact);
    splats[1].color[0] = glm::vec3(0.9f);
    EXPECT_NEAR(depth_of(*this, view(), 32, 32).value(), 9.0, exact);
}

/// As camera.focus_distance is.
TEST_F(LayersAtPixel, DepthIsAlongTheAxis) {
    add("aside", {3.0f, 0.0f, 0.0f}, glm::vec3(0.5f));
    PreviewView perspective = view();
    CameraParams params;
    params.position = glm::dvec3(0.0, 0.0, 10.0);
    perspective.camera = make_camera(params, double(size), double(size), {});
    const auto x =
        static_cast<std::int64_t>(perspective.camera.center_x_px + 0.3 * perspective.camera.focal_px);
    EXPECT_NEAR(depth_of(*this, perspective, x, 32).value(), 10.0, 20.0 / 1024.0);
}

TEST(SeenLayers, WhatCannotBeToldFromBlackIsLeftOut) {
    EXPECT_EQ(seen_layers({1.0f, 0.01f, 5.0f, 0.2f, 0.0f}), (std::vector<std::size_t>{2, 0, 3}));
    EXPECT_TRUE(seen_layers({0.0f, 0.0f}).empty());
    EXPECT_TRUE(seen_layers({}).empty());
}

TEST(ClickedLayer, AnotherClickTakesTheNextOneAndThenTheFirstAgain) {
    const std::vector<std::size_t> seen{2, 0, 3};
    EXPECT_EQ(clicked_layer(seen, 0, false), 2u);
    EXPECT_EQ(clicked_layer(seen, 2, true), 0u);
    EXPECT_EQ(clicked_layer(seen, 0, true), 3u);
    EXPECT_EQ(clicked_layer(seen, 3, true), 2u);
    EXPECT_EQ(clicked_layer(seen, 1, true), 2u) << "the selected layer is not here";
    EXPECT_EQ(clicked_layer({}, 1, true), std::nullopt);
}

}  // namespace
}  // namespace astrosplat
