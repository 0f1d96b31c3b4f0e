// Splats as Gaussians, and captures with colours by direction.
#include "gaussians/gaussians.h"

#include <numbers>

#include "core/color.h"
#include "core/parallel.h"
#include "core/rotation.h"
#include "gaussians/gaussian_file.h"
#include "render/footprint.h"
#include "render/render.h"
#include "splat_files/splat_file.h"
#include "splats/harmonics.h"
#include "support/capture.h"
#include "support/test.h"

namespace astrosplat::test {
namespace {

// Splats as Gaussians: the integral by summing over a fine grid, blends by hand,
// and fewer with the same light.

Falloff falloff_of(Falloff::Shape shape, float sharpness = 4.5f) {
    Falloff falloff;
    falloff.shape = shape;
    falloff.sharpness = sharpness;
    return falloff;
}

/// Sum of f(r) over a grid of the square from -6 to 6.
template <class F>
double sum_over_plane(F&& f) {
    constexpr double step = 0.01;
    double sum = 0.0;
    for (double y = -6.0 + step / 2; y < 6.0; y += step)
        for (double x = -6.0 + step / 2; x < 6.0; x += step) sum += f(std::hypot(x, y)) * step * step;
    return sum;
}

void add_splat(ShadedSplats& splats, const glm::vec3& position, const glm::vec3& color, float alpha,
               float radius) {
    splats.id.push_back(splats.id.size());
    splats.position.push_back(position);
    splats.color.push_back(color);
    splats.alpha.push_back(alpha);
    splats.radius.push_back(radius);
}

ShadedSplats one_splat(const glm::vec3& color, float alpha, float radius = 1.0f) {
    ShadedSplats splats;
    add_splat(splats, {1.0f, 2.0f, 3.0f}, color, alpha, radius);
    return splats;
}

struct One {
    Gaussians gaussians;
    BakeCounts counts;
    double peak;
};

One baked(const ShadedSplats& splats, const LayerRender& render, double gain = 1.0) {
    RenderLayer layer;
    layer.splats = &splats;
    layer.render = render;
    layer.scale = 2.0;
    layer.translate = {0.0, 0.0, -1.0};
    One one;
    one.peak = nearest_gaussian(render.falloff).peak;
    bake_layer(layer, Camera{}, gain, one.gaussians, one.counts);
    return one;
}

LayerRender blend_of(Blend blend) {
    LayerRender render;
    render.blend = blend;
    return render;
}

TEST(Gaussians, HaveTheIntegralOfTheSplat) {
    for (const Falloff& falloff :
         {falloff_of(Falloff::Shape::constant), falloff_of(Falloff::Shape::linear),
          falloff_of(Falloff::Shape::trapezoid), falloff_of(Falloff::Shape::gaussian),
          falloff_of(Falloff::Shape::gaussian, 20.0f), falloff_of(Falloff::Shape::exponential, 6.0f)}) {
        const GaussianProfile g = nearest_gaussian(falloff);
        const double splat = sum_over_plane([&](double r) { return falloff_value(falloff, r); });
        const double gaussian =
            sum_over_plane([&](double r) { return g.peak * std::exp(-r * r / (2 * g.sigma * g.sigma)); });
        EXPECT_NEAR(gaussian / splat, 1.0, 2e-3) << int(falloff.shape);
    }
}

TEST(Gaussians, OfAConstantSplatHasALogarithmInClosedForm) {
    const GaussianProfile g = nearest_gaussian(falloff_of(Falloff::Shape::constant));
    EXPECT_NEAR(g.peak, std::log(4.0), 1e-5);
    EXPECT_NEAR(g.sigma, std::sqrt(0.5 / std::log(4.0)), 1e-5);
}

TEST(Gaussians, OfAGaussianSplatIsNearlyItself) {
    const GaussianProfile g = nearest_gaussian(falloff_of(Falloff::Shape::gaussian, 20.0f));
    EXPECT_NEAR(g.peak, 1.0, 1e-4);
    EXPECT_NEAR(g.sigma, std::sqrt(0.5 / 20.0), 1e-4);
}

TEST(Gaussians, StandWhereTheLayerPutsThem) {
    const One one = baked(one_splat({0.5f, 0.25f, 0.125f}, 0.5f, 0.5f), blend_of(Blend::over));
    ASSERT_EQ(one.gaussians.size(), 1);
    EXPECT_EQ(one.gaussians.position[0], glm::vec3(2.0f, 4.0f, 5.0f));
    EXPECT_NEAR(one.gaussians.scale[0].x, nearest_gaussian(Falloff{}).sigma, 1e-6);  // radius 0.5, scale 2
    EXPECT_NEAR(one.gaussians.alpha[0], 0.5 * one.peak, 1e-6);
    EXPECT_NEAR(one.gaussians.color[0].y, 0.25f, 1e-6);
}

TEST(Gaussians, OfOpaqueDiscsAreWiderInsteadOfMoreThanOpaque) {
    LayerRender render;
    render.falloff = falloff_of(Falloff::Shape::constant);
    const One one = baked(one_splat(glm::vec3(0.5f), 1.0f, 0.5f), render);
    EXPECT_EQ(one.gaussians.alpha[0], 1.0f);
    EXPECT_NEAR(2.0 * std::numbers::pi * std::pow(one.gaussians.scale[0].x, 2.0), std::numbers::pi, 1e-4);
    EXPECT_NEAR(one.gaussians.color[0].x, 0.5f, 1e-6);
    EXPECT_EQ(one.counts.lost, 0.0);
}

TEST(Gaussians, RaiseAlphaForBrightColoursAndCountWhatIsLost) {
    const One fits = baked(one_splat({1.5f, 0.75f, 0.0f}, 0.1f), blend_of(Blend::over), 2.0);
    EXPECT_NEAR(fits.gaussians.alpha[0], 0.3 * fits.peak, 1e-6);
    EXPECT_NEAR(fits.gaussians.color[0].x, 1.0f, 1e-6);
    EXPECT_NEAR(fits.gaussians.color[0].y, 0.5f, 1e-6);
    EXPECT_EQ(fits.counts.bright, 0);
    EXPECT_EQ(fits.counts.share_lost(), 0.0);
    const One clipped = baked(one_splat(glm::vec3(4.0f), 0.8f), blend_of(Blend::over));
    EXPECT_EQ(clipped.gaussians.alpha[0], 1.0f);
    EXPECT_EQ(clipped.counts.bright, 1);
    EXPECT_NEAR(clipped.counts.share_lost(), 1.0 - 1.0 / (0.8 * clipped.peak * 4.0), 1e-5);
}

TEST(Gaussians, HideWhatTheBlendHides) {
    const ShadedSplats splats = one_splat({0.5f, 0.25f, 0.0f}, 0.4f);
    for (const Blend blend : {Blend::add, Blend::screen}) {  // the least that shows the light
        const One one = baked(splats, blend_of(blend));
        EXPECT_NEAR(one.gaussians.alpha[0], 0.2 * one.peak, 1e-6);
        EXPECT_NEAR(one.gaussians.color[0].y, 0.5f, 1e-6);
    }
    const One dust = baked(splats, blend_of(Blend::absorb));
    EXPECT_EQ(dust.gaussians.color[0], glm::vec3(0.0f));
    EXPECT_EQ(dust.counts.dust, 1);
    EXPECT_EQ(baked(one_splat(glm::vec3(0.0f), 0.4f), blend_of(Blend::add)).counts.unseen, 1);
}

ShadedSplats cloud(int count, float alpha) {
    ShadedSplats splats;
    for (int i = 0; i < count; ++i) {
        const double turn = i * 2.399963, r = 0.9 * std::sqrt((i + 0.5) / count);
        add_splat(splats, glm::dvec3(r * std::cos(turn), r * std::sin(turn), 0.3 * std::sin(i * 1.7)),
                  {0.8f, 0.5f, 0.3f}, alpha, 0.25f);
    }
    return splats;
}

double light_of(const ShadedSplats& splats) {
    double light = 0.0;
    for (std::size_t i = 0; i < splats.id.size(); ++i)
        light += splats.alpha[i] * std::pow(splats.radius[i], 2.0) * splats.color[i].y;
    return light;
}

TEST(Gaussians, FewerHaveTheSameLight) {
    const ShadedSplats many = cloud(3000, 0.01f);
    RenderLayer layer;
    layer.splats = &many;
    layer.render.blend = Blend::add;
    layer.render.opacity = 0.5f;
    const auto reduced = reduce_splats({&layer, 1}, glm::dmat3(1.0), 200);
    EXPECT_LE(reduced.front().size(), 200);
    EXPECT_GE(reduced.front().size(), 100);
    EXPECT_NEAR(light_of(reduced.front()) / (0.5 * light_of(many)), 1.0, 1e-4);
    EXPECT_EQ(reduce_splats({&layer, 1}, glm::dmat3(1.0), 3000).front().size(), 3000);
    layer.render.lod = {1.0f, 64, 1.0f};  // a camera's
    EXPECT_EQ(reduce_splats({&layer, 1}, glm::dmat3(1.0), 200).front().color, reduced.front().color);
}

/// Root of the mean square of display differences between two frames in linear light and encoded light.
double display_difference(const Image& linear, const Image& encoded) {
    double sum = 0.0;
    for (std::size_t i = 0; i < linear.pixels.size(); ++i)
        sum += std::pow(double(display_srgb(linear.pixels[i])) - double(encoded.pixels[i]), 2.0);
    return std::sqrt(sum / double(linear.pixels.size()));
}

TEST(Gaussians, EncodedAreFittedToTheFrame) {
    const ShadedSplats splats = cloud(600, 0.02f);
    RenderLayer layer;
    layer.splats = &splats;
    CameraParams params;
    params.position = glm::dvec3(0.0, 0.0, 4.0);
    const Camera camera = make_camera(params, 96.0, 96.0, {});
    RenderSettings settings;
    settings.width = settings.height = 96;
    const Image wanted = render({&layer, 1}, camera, nullptr, settings).beauty;
    Gaussians gaussians;
    BakeCounts counts;
    bake_layer(layer, camera, 1.0, gaussians, counts);
    encode_for_display(gaussians);
    const auto seen = [&] {
        ShadedSplats drawn = splats;
        drawn.color = gaussians.color;
        drawn.alpha = gaussians.alpha;
        drawn.radius.clear();
        for (const glm::vec3& scale : gaussians.scale) drawn.radius.push_back(scale.x);
        for (float& radius : drawn.radius) radius *= 4.0f;
        RenderLayer as_gaussians;
        as_gaussians.splats = &drawn;
        as_gaussians.render.falloff.sharpness = 8.0f;
        Image image = render({&as_gaussians, 1}, camera, nullptr, settings).beauty;
        for (std::size_t i = 3; i < image.pixels.size(); i += 4)
            image.pixels[i] = display_srgb(wanted.pixels[i]);  // alpha is no light
        return image;
    };
    EXPECT_GT(display_difference(wanted, seen()), 0.05);
    fit_to_view(gaussians, wanted, camera, settings);
    EXPECT_LT(display_difference(wanted, seen()), 0.01);  // 40 dB
}

// Gaussians that were read, through the baker and the writers, and read again; and USD text.

/// A capture as a layer shows it, untouched: what the pipeline hands to export.
struct ShownCapture {
    SplatSet set;
    ShadedSplats splats;
    RenderLayer layer;

    explicit ShownCapture(const fs::path& file) : set(read_splats(file)) {
        splats.position = set.position;
        splats.color = set.color;
        splats.alpha = set.alpha;
        splats.radius = set.radius;
        splats.id = set.id;
        for (std::size_t i = 0; i < set.scale.size(); ++i) {
            glm::dmat3 m = matrix_of_quaternion(glm::dvec4(set.rotation[i]));
            for (int k = 0; k < 3; ++k) m[k] *= 3.0 * double(set.scale[i][k]) / double(set.radius[i]);
            splats.stretch.push_back(glm::mat3(m));
        }
        layer.splats = &splats;
        layer.gaussians = true;
    }
};

void expect_same_gaussians(const SplatSet& a, const SplatSet& b, double tolerance) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.position.size(); ++i) {
        EXPECT_EQ(a.position[i], b.position[i]);
        EXPECT_NEAR(a.alpha[i], b.alpha[i], tolerance);
        EXPECT_NEAR(std::fabs(glm::dot(a.rotation[i], b.rotation[i])), 1.0, tolerance);
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(a.scale[i][k] / b.scale[i][k], 1.0, tolerance);
            EXPECT_NEAR(a.color[i][k], b.color[i][k], tolerance * std::max(1.0f, b.color[i][k]));
        }
    }
}

// Read, exported and read again: the same Gaussians, also those brighter than 1.
TEST(GaussianFile, ThatWereReadComeOutAsTheyAre) {
    const TempFolder folder;
    ShownCapture shown(folder.file("a.ply", ply_of(capture(200, 0), 0)));
    Gaussians gaussians;
    BakeCounts counts;
    bake_layer(shown.layer, Camera{}, 1.0, gaussians, counts);
    EXPECT_EQ(counts.lost, 0.0);
    write_gaussian_glb(folder / "linear.glb", gaussians, false);
    expect_same_gaussians(read_splats(folder / "linear.glb"), shown.set, 3e-6);
    encode_for_display(gaussians);
    gaussians.credit = "NASA, \"ESA\"; É. Méchain \\ M 104";
    gaussians.origin = "measured: light; invented: depths";
    write_gaussian_ply(folder / "b.ply", gaussians);
    write_gaussian_glb(folder / "b.glb", gaussians, true);
    expect_same_gaussians(read_splats(folder / "b.ply"), shown.set, 3e-6);
    expect_same_gaussians(read_splats(folder / "b.glb"), shown.set, 3e-6);
    write_gaussian_usda(folder / "b.usda", gaussians);
    expect_same_gaussians(read_splats(folder / "b.usda"), shown.set, 3e-6);
    for (const char* file : {"b.ply", "b.glb"}) {
        EXPECT_EQ(read_splats(folder / file).credit, gaussians.credit);
        EXPECT_EQ(read_splats(folder / file).origin, gaussians.origin);
    }
    EXPECT_HAS(test::bytes_of(folder / "b.usda"), R"(string credit = "NASA, \"ESA\"; É. Méchain \\ M 104")");
    EXPECT_HAS(test::bytes_of(folder / "b.usda"), R"(string origin = "measured: light; invented: depths")");
    // A turned and doubled layer turns and doubles them.
    shown.layer.world_from_layer = rotation_from_degrees({20.0, 30.0, 40.0});
    shown.layer.scale = 2.0;
    Gaussians turned;
    bake_layer(shown.layer, Camera{}, 1.0, turned, counts);
    const glm::dmat3 wanted =
        rotation_from_degrees({20.0, 30.0, 40.0}) * matrix_of_quaternion(glm::dvec4(shown.set.rotation[5]));
    const glm::dmat3 found = matrix_of_quaternion(glm::dvec4(turned.rotation[5]));
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(turned.scale[5][k] / shown.set.scale[5][k], 2.0, 1e-5);
        EXPECT_NEAR(glm::length(found[k] - wanted[k]), 0.0, 1e-5);
    }
}

Gaussians gaussians_of(const std::vector<Trained>& all, int degree, double size) {
    Gaussians out;
    out.degree = degree;
    for (const Trained& g : all) {
        Harmonics harmonics{};
        for (std::size_t j = 0; j < 16; ++j) harmonics.c[j] = glm::vec3(g.harmonics[j]);
        out.position.push_back(glm::vec3(size * g.position));
        out.color.push_back(mean_color(harmonics));
        out.alpha.push_back(float(g.opacity));
        out.scale.push_back(glm::vec3(g.scale));
        out.rotation.push_back(glm::vec4(g.rotation));
        if (degree > 0) out.harmonics.push_back(harmonics);
    }
    return out;
}

// A galaxy's halo is made of such.
TEST(GaussianFile, FaintGaussiansOfSpzShineAsMuchTogether) {
    const TempFolder folder;
    constexpr std::size_t count = 40000;
    for (const double codes : {0.1, 0.4, 1.7}) {
        Gaussians wanted = gaussians_of(capture(1, 0), 0, 1.0);
        wanted.position.resize(count, wanted.position[0]);
        wanted.color.resize(count, wanted.color[0]);
        wanted.scale.resize(count, wanted.scale[0]);
        wanted.rotation.resize(count, wanted.rotation[0]);
        wanted.alpha.assign(count, float(codes / 255.0));
        write_gaussian_spz({folder / "a.spz", Existing::replace}, wanted);
        double sum = 0.0;
        for (const float alpha : read_splats(folder / "a.spz").alpha) {
            EXPECT_LT(std::fabs(255.0 * alpha - codes), 1.0);
            sum += 255.0 * alpha;
        }
        const double part = codes - std::floor(codes), deviation = std::sqrt(part * (1.0 - part) / count);
        EXPECT_NEAR(sum / count, codes, 4.0 * deviation);
    }
}

// Numbers of SPZ are off by half a step at most, in scenes of any size.
TEST(GaussianFile, SpzIsReadBackWithinItsSteps) {
    const TempFolder folder;
    for (const int degree : {0, 1, 2, 3})
        for (const auto& [size, step] : std::initializer_list<std::pair<double, double>>{
                 {1.0, 1.0 / 4096}, {1000.0, 1.0 / 2048}, {0.01, 1.0 / (1 << 17)}}) {
            const std::vector<Trained> all = capture(200, degree);
            const Gaussians wanted = gaussians_of(all, degree, size);
            const fs::path file = folder / "a.spz";
            write_gaussian_spz(file, wanted);
            const SplatSet set = read_splats(file);
            ASSERT_EQ(set.size(), 200);
            ASSERT_EQ(set.harmonics.empty(), degree == 0);
            for (std::size_t i = 0; i < 200; ++i) {
                EXPECT_NEAR(set.alpha[i], wanted.alpha[i], 0.5 / 255 + 1e-6);
                for (int k = 0; k < 3; ++k) {
                    EXPECT_NEAR(set.position[i][k], wanted.position[i][k], 0.5 * step + 1e-7 * size) << size;
                    EXPECT_NEAR(std::log(set.scale[i][k] / wanted.scale[i][k]), 0.0, 0.5 / 16 + 1e-6);
                    EXPECT_NEAR(real::linear_to_srgb(set.color[i][k]), std::max(wanted.color[i][k], 0.0f),
                                0.5 / 255 / 0.15 * double(harmonic_0) + 1e-5);
                    for (std::size_t j = 1; j < harmonics_up_to(degree); ++j)
                        EXPECT_NEAR(set.harmonics[i].c[j][k], wanted.harmonics[i].c[j][k],
                                    (j < 4 ? 4.5 : 8.5) / 128 + 1e-6)
                            << j;
                }
                // Three numbers off by half a step of sqrt(1/2) / 511, and the fourth by as much as they.
                const double cosine = glm::dot(glm::dvec4(set.rotation[i]), all[i].rotation);
                EXPECT_LT(std::sqrt(std::max(0.0, 1.0 - cosine * cosine)),
                          2.0 * std::sqrt(3.0) * 0.5 / 511 * std::sqrt(0.5));
            }
            const std::string bytes = test::bytes_of(file);
            set_thread_count(1);
            write_gaussian_spz(file, wanted);
            set_thread_count(0);
            EXPECT_EQ(test::bytes_of(file), bytes);
            EXPECT_THROW(write_gaussian_spz({file, Existing::keep}, wanted), AlreadyExists);
        }
}

ShadedSplats one_of_radius_3() {
    ShadedSplats splats;
    add_splat(splats, glm::vec3(0.0f), glm::vec3(0.5f), 0.5f, 3.0f);
    return splats;
}

TEST(GaussianFile, FlatOnesAndNeedlesKeepTheirDirections) {
    for (const glm::dvec3& scale :
         {glm::dvec3(0.0, 1.0, 2.0), glm::dvec3(0.0, 0.0, 2.0), glm::dvec3(1.0, 0.0, 0.0)}) {
        ShadedSplats splats = one_of_radius_3();
        glm::dmat3 m = rotation_from_degrees({50.0, 60.0, 70.0});
        for (int k = 0; k < 3; ++k) m[k] *= scale[k];
        splats.stretch.push_back(glm::mat3(m));
        RenderLayer layer;
        layer.splats = &splats;
        layer.gaussians = true;
        Gaussians gaussians;
        BakeCounts counts;
        bake_layer(layer, Camera{}, 1.0, gaussians, counts);
        ASSERT_EQ(gaussians.size(), 1);
        const glm::dmat3 axes = matrix_of_quaternion(glm::dvec4(gaussians.rotation[0]));
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(gaussians.scale[0][k], scale[k], 1e-6);
            EXPECT_NEAR(glm::length(axes[k] * scale[k] - m[k]), 0.0, 1e-6);
        }
    }
}

// Field by field as text, for other readers than ours.
TEST(GaussianFile, UsdTextSaysWhatTheyAre) {
    const TempFolder folder;
    Gaussians g;
    for (int i = 0; i < 10; ++i) {
        g.position.push_back({0.5f * float(i), -1.0f, 2.0f});
        g.color.push_back(glm::vec3(0.5f));
        g.alpha.push_back(0.25f);
        g.scale.push_back({1.0f, 2.0f, 0.125f});
        g.rotation.push_back({0.0f, 0.6f, 0.0f, 0.8f});
    }
    write_gaussian_usda(folder / "a.usda", g);
    const std::string text = test::bytes_of(folder / "a.usda");
    EXPECT_EQ(text.find("#usda 1.0\n("), 0u);
    EXPECT_TRUE(text.ends_with("interpolation = \"vertex\"\n    )\n}\n")) << text;
    for (const char* part :
         {"def ParticleField3DGaussianSplat \"Splats\"\n{\n    float3[] extent = [(-6, -7, -4), (10.5, 5, "
          "8)]\n",
          "    point3f[] positions = [(0, -1, 2), (0.5, -1, 2), ",
          "(3.5, -1, 2), \n        (4, -1, 2), (4.5, -1, 2)]\n",
          "    quatf[] orientations = [(0.8, 0, 0.6, 0), ", "    float3[] scales = [(1, 2, 0.125), ",
          "    float[] opacities = [0.25, 0.25", "    uniform int radiance:sphericalHarmonicsDegree = 0\n",
          "Coefficients = [(0, 0, 0), ", "upAxis = \"Y\""})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
}

// Captures with colours by direction, baked and written and read again: the same colours in all directions
// where nothing changed them, and those of the frame in the direction it is seen from where something did.

glm::vec3 linear(glm::vec3 color) {
    for (int k = 0; k < 3; ++k) color[k] = float(real::srgb_to_linear(color[k]));
    return color;
}

/// The linear light of row i in a direction.
glm::vec3 light_of(const SplatSet& set, std::size_t i, const glm::dvec3& direction) {
    if (set.harmonics.empty()) return set.color[i];
    const glm::vec3 color = color_towards(set.harmonics[i], glm::vec3(direction));
    return set.display_harmonics ? linear(color) : color;
}

/// A capture as a frame shows it: its light as the camera sees it, times `factor`.
struct SeenCapture {
    TempFolder folder;
    SplatSet set;
    ShadedSplats splats;
    RenderLayer layer;
    Camera camera;
    glm::vec3 factor{1.0f};

    explicit SeenCapture(const std::string& name, const std::string& bytes)
        : set(read_splats(folder.file(name, bytes))) {
        camera.eye = {1.0, 2.0, 9.0};
        layer.gaussians = true;
        if (!set.harmonics.empty()) layer.directional = &set;
    }
    glm::dvec3 place(std::size_t i) const {
        return layer.world_from_layer * (layer.scale * glm::dvec3(set.position[i])) + layer.translate;
    }
    /// In the layer's axes.
    glm::dvec3 to_camera(std::size_t i) const {
        return glm::transpose(layer.world_from_layer) * glm::normalize(place(i) - camera.eye);
    }
    Gaussians baked(bool encoded) {
        splats = {};
        for (std::size_t i = 0; i < set.position.size(); ++i) {
            if (i % 7 == 3) continue;  // what a look leaves out
            splats.position.push_back(set.position[i]);
            splats.color.push_back(factor * light_of(set, i, to_camera(i)));
            splats.alpha.push_back(set.alpha[i]);
            splats.radius.push_back(set.radius[i]);
            splats.id.push_back(set.id[i]);
            splats.stretch.push_back(glm::mat3(0.3f));
        }
        layer.splats = &splats;
        Gaussians gaussians;
        BakeCounts counts;
        bake_layer(layer, camera, 1.0, gaussians, counts);
        if (encoded) encode_for_display(gaussians);
        finish_harmonics(gaussians, camera, encoded);
        return gaussians;
    }
    SplatSet again(const Gaussians& gaussians, const std::string& name, bool encoded) {
        const fs::path file = folder / name;
        if (name.ends_with(".ply"))
            write_gaussian_ply({file, Existing::replace}, gaussians);
        else if (name.ends_with(".usda"))
            write_gaussian_usda({file, Existing::replace}, gaussians);
        else
            write_gaussian_glb({file, Existing::replace}, gaussians, encoded);
        return read_splats(file);
    }
    std::size_t row(std::size_t kept) const { return kept + (kept + 3) / 6; }
};

constexpr int directions = 24;
glm::dvec3 direction(int n) {
    const double z = 1.0 - 2.0 * (n + 0.5) / directions, r = std::sqrt(1.0 - z * z);
    return {r * real::cos(2.4 * n), r * real::sin(2.4 * n), z};
}

/// Differences of colours over all directions, as a display shows them; of channels that the camera sees
/// bright enough to tell what became of them.
struct Differences {
    double largest = 0.0, mean = 0.0;  // root of the mean square
};
Differences differences(const SeenCapture& capture, const SplatSet& found, double bright = 0.0) {
    Differences d;
    double squares = 0.0, count = 0.0;
    for (std::size_t i = 0; i < found.position.size(); ++i) {
        const std::size_t row = capture.row(i);
        const glm::vec3 seen = light_of(capture.set, row, capture.to_camera(row));
        for (int n = 0; n < directions; ++n) {
            const glm::vec3 wanted = capture.factor * light_of(capture.set, row, direction(n)),
                            is = light_of(found, i, capture.layer.world_from_layer * direction(n));
            for (int k = 0; k < 3; ++k) {
                if (double(seen[k]) < bright) continue;
                const double off = std::fabs(real::linear_to_srgb(is[k]) - real::linear_to_srgb(wanted[k]));
                d.largest = std::max(d.largest, off);
                squares += off * off;
                ++count;
            }
        }
    }
    d.mean = std::sqrt(squares / count);
    return d;
}

TEST(HarmonicsExport, CapturesComeOutWithTheColoursThatTheyCameWith) {
    for (const int degree : {0, 1, 2, 3}) {
        SeenCapture capture("in.ply", ply_of(test::capture(60, degree), degree));
        capture.layer.world_from_layer = rotation_from_degrees({20.0, 130.0, 40.0});
        capture.layer.scale = 2.0;
        const Gaussians gaussians = capture.baked(true);
        EXPECT_EQ(gaussians.degree, degree);
        for (const char* name : {"out.ply", "out.glb", "out.usda"}) {
            const SplatSet found = capture.again(gaussians, name, true);
            ASSERT_EQ(found.position.size(), 51u);
            EXPECT_EQ(found.harmonics.empty(), degree == 0);
            EXPECT_LT(differences(capture, found).largest, 1e-4) << degree << " " << name;
        }
        const std::string header = bytes_of(capture.folder / "out.ply");
        const int rest = 3 * ((degree + 1) * (degree + 1) - 1);
        const auto has = [&](int n) {
            return header.find("property float f_rest_" + std::to_string(n) + "\n") != std::string::npos;
        };
        EXPECT_TRUE(rest == 0 || has(rest - 1));
        EXPECT_FALSE(has(rest));
    }
}

// Converted light is exact in the direction of view; where both spaces are linear, in every direction.
TEST(HarmonicsExport, WhatTheLookDoesIsDoneToAllDirections) {
    SeenCapture linear_one("in.glb", glb_of(test::capture(60, 3), 3, "", "lin_rec709_display"));
    linear_one.factor = {0.5f, 0.25f, 0.8f};
    const SplatSet linear_found = linear_one.again(linear_one.baked(false), "out.glb", false);
    EXPECT_LT(differences(linear_one, linear_found, 0.05).largest, 1e-3);

    SeenCapture capture("in.ply", ply_of(test::capture(60, 3), 3));
    capture.factor = {0.5f, 0.25f, 0.8f};
    const SplatSet found = capture.again(capture.baked(true), "out.ply", true);
    for (std::size_t i = 0; i < found.position.size(); ++i) {
        const glm::dvec3 seen = capture.to_camera(capture.row(i));
        const glm::vec3 wanted = capture.factor * light_of(capture.set, capture.row(i), seen),
                        is = light_of(found, i, seen);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(is[k], wanted[k], 1e-4) << i;
    }
    EXPECT_LT(differences(capture, found, 0.05).mean, 0.03);
}

TEST(HarmonicsExport, DisplayValuesBecomeLinearLight) {
    SeenCapture capture("in.ply", ply_of(test::capture(60, 3), 3));
    const SplatSet found = capture.again(capture.baked(false), "out.glb", false);
    EXPECT_FALSE(found.display_harmonics);
    EXPECT_LT(differences(capture, found).mean, 0.05);
}

// Splats drawn with a capture have their colour from everywhere, and what has no directions no file tells of.
TEST(HarmonicsExport, OthersKeepTheirColour) {
    SeenCapture capture("in.ply", ply_of(test::capture(60, 1), 1));
    RenderLayer plain;
    ShadedSplats one;
    one.position.push_back({1.0f, 0.0f, 0.0f});
    one.color.push_back({0.3f, 0.2f, 0.1f});
    one.alpha.push_back(0.5f);
    one.radius.push_back(0.1f);
    one.id.push_back(0);
    plain.splats = &one;
    Gaussians gaussians;
    BakeCounts counts;
    bake_layer(plain, capture.camera, 1.0, gaussians, counts);
    capture.baked(true);
    bake_layer(capture.layer, capture.camera, 1.0, gaussians, counts);
    bake_layer(plain, capture.camera, 1.0, gaussians, counts);
    finish_harmonics(gaussians, capture.camera, false);
    const SplatSet found = capture.again(gaussians, "out.glb", false);
    ASSERT_EQ(found.position.size(), 53u);
    for (const std::size_t i : {std::size_t{0}, std::size_t{52}})
        for (int n = 0; n < directions; ++n)
            EXPECT_LT(glm::length(light_of(found, i, direction(n)) - one.color[0]), 1e-5f) << i;
}

}  // namespace
}  // namespace astrosplat::test
