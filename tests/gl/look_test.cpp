// The look on the GPU, splat by splat, against apply_look, for every operator; and the uniform block it
// reads.
#include <unordered_map>

#include "gl/gl_fixture.h"
#include "gl/passes.h"
#include "gl/picture_scenes.h"
#include "look/prepare.h"
#include "support/test.h"

namespace astrosplat {
namespace {

using test::GlTest;

constexpr std::int64_t count = 20000;

/// A splat as the GPU shaded it, in the order of ShadedSplats' arrays.
struct Shaded {
    float values[8];
};

struct LookCase {
    const char* name;
    std::function<void(SplatSet&, Look&, LookInputs&)> set_up;
};

Look with_radius() {
    Look look;
    look.radius.min = 0.01f;
    look.radius.max = 0.03f;
    return look;
}

Noise noise_of(float Noise::*amount, float value) {
    Noise noise;
    noise.frequency = 2.5f;
    noise.seed = 7;
    noise.*amount = value;
    return noise;
}

const Image& map_picture() {
    static const Image image = [] {
        Image made = make_image(7, 5, 3);
        for (std::size_t i = 0; i < made.pixels.size(); ++i) made.pixels[i] = float(i * 37 % 101) / 100.0f;
        return made;
    }();
    return image;
}

LookCase pdf_case(const char* name, DensityCurve::Shape shape) {
    return {name, [shape](SplatSet&, Look& look, LookInputs&) {
                look.pdf.shape = shape;
                look.pdf.points = {{0.0f, 1.0f}, {0.3f, 0.4f}, {0.7f, 0.6f}, {1.0f, 0.0f}};
            }};
}

LookCase vertical_case(const char* name, VerticalAlpha::Shape shape) {
    return {name, [shape](SplatSet&, Look& look, LookInputs&) {
                look.vertical.shape = shape;
                look.vertical.points = {{0.0f, 1.0f}, {0.5f, 0.2f}, {1.0f, 0.1f}};
            }};
}

LookCase match_case(const char* name, VerticalAlpha::Match match, ColumnLaw law) {
    return {name, [match, law](SplatSet& set, Look& look, LookInputs& inputs) {
                // Squares of a picture are solved for the final frame alone: without u, v there are none.
                if (match == VerticalAlpha::Match::picture) set.uv.clear();
                look.vertical.shape = VerticalAlpha::Shape::linear;
                look.vertical.match = match;
                inputs.column = law;
            }};
}

LookCase noise_case(const char* name, float Noise::*amount, float value) {
    return {name, [amount, value](SplatSet&, Look& look, LookInputs& inputs) {
                inputs.axis = {0.1f, 0.9f, -0.3f};
                look.noise = {noise_of(amount, value), noise_of(amount, 0.5f * value)};
                look.noise[1].octaves = 7;
                look.noise[1].seed = 12;
            }};
}

void set_stops(SplatSet&, Look& look, LookInputs& inputs) {
    look.thickness.map = "map.exr";
    inputs.thickness_map = &map_picture();
    ThicknessStop dark, bright;
    dark.color = {0.1f, 0.2f, 0.1f};
    dark.pdf.shape = DensityCurve::Shape::exponential;
    bright.scale = 0.6f;
    bright.pdf.shape = DensityCurve::Shape::curve;
    bright.pdf.points = {{0.0f, 1.0f}, {1.0f, 0.3f}};
    look.thickness.stops = {dark, bright, {{0.5f, 0.1f, 0.9f}, 1.3f, {}}};
}

std::vector<LookCase> all_cases() {
    using Pdf = DensityCurve::Shape;
    using Vertical = VerticalAlpha::Shape;
    using Match = VerticalAlpha::Match;
    return {
        {"defaults", [](SplatSet&, Look&, LookInputs&) {}},
        {"reach and density",
         [](SplatSet&, Look& look, LookInputs&) { look.reach = 0.15f, look.density = 0.6f; }},
        pdf_case("linear", Pdf::linear),
        pdf_case("quadratic", Pdf::quadratic),
        pdf_case("exponential", Pdf::exponential),
        pdf_case("gaussian", Pdf::gaussian),
        pdf_case("smooth", Pdf::smooth),
        pdf_case("curve", Pdf::curve),
        {"thickness stops", set_stops},
        noise_case("cull", &Noise::cull, 0.8f),
        noise_case("silhouette", &Noise::silhouette, 0.7f),
        noise_case("jitter", &Noise::jitter, 0.1f),
        noise_case("alpha noise", &Noise::alpha, 0.5f),
        noise_case("brightness", &Noise::brightness, 0.9f),
        {"splats that absorb",
         [](SplatSet& set, Look& look, LookInputs&) {
             set.absorbs = true;
             for (std::size_t i = 0; i < set.color.size(); i += 3)
                 set.color[i] = glm::vec3(-0.8f, -1.0f, -1.3f);
             look.alpha = {1.7f, 0.8f, true, 1.2f};
             look.grade.gain = 2.0f;
         }},
        {"horizontal alpha",
         [](SplatSet&, Look& look, LookInputs&) {
             look.alpha = {1.7f, 0.8f, true, 1.2f};
             look.radius.horizontal_scale = 2.5f;
         }},
        vertical_case("linear falloff", Vertical::linear),
        vertical_case("exponential falloff", Vertical::exponential),
        vertical_case("s106", Vertical::s106),
        vertical_case("curve falloff", Vertical::curve),
        {"vertical reach",
         [](SplatSet&, Look& look, LookInputs&) {
             look.vertical.shape = Vertical::linear;
             look.vertical.reach = 0.3f;
             look.radius.vertical_scale = 0.4f;
         }},
        match_case("sum", Match::sum, ColumnLaw::transmittance),
        match_case("coverage", Match::coverage, ColumnLaw::transmittance),
        match_case("coverage of light", Match::coverage, ColumnLaw::sum),
        match_case("light under screen", Match::picture, ColumnLaw::screen),
        {"crops",
         [](SplatSet&, Look& look, LookInputs&) {
             look.crop.resize(3);
             look.crop[0].size = glm::vec3(1.5f);
             look.crop[0].rotate = {10.0f, 20.0f, 30.0f};
             look.crop[0].soft = 0.4f;
             look.crop[1].shape = Crop::Shape::sphere;
             look.crop[1].radius = 0.3f;
             look.crop[1].soft = 0.2f;
             look.crop[1].keep = Crop::Keep::outside;
             look.crop[2].size = glm::vec3(1.2f);
         }},
        {"own radii", [](SplatSet&, Look& look, LookInputs&) { look.radius = {}; }},
        {"grade",
         [](SplatSet&, Look& look, LookInputs&) {
             look.grade = {1.5f, {0.9f, 1.0f, 1.2f}, 0.6f, 1.8f, 0.1f};
         }},
    };
}

class GpuLook : public GlTest {
  protected:
    /// Kept splats by id.
    std::unordered_map<std::uint64_t, Shaded> run(const std::shared_ptr<const SplatSet>& set,
                                                  const Look& look, const LookInputs& inputs) {
        LookPass pass;
        RawSplats raw(set);
        raw.hold();
        ShadedBuffers out;
        out.resize(set->size());
        const LookUniforms uniforms = prepare_look(*set, look, inputs);
        pass.run(raw, {uniforms, inputs.thickness_map}, out, 0);
        const Buffer<glm::vec4> places = out.read_places(), colors = out.read_colors();
        std::unordered_map<std::uint64_t, Shaded> kept;
        for (std::size_t i = 0; i < places.size(); ++i)
            if (places[i].w >= 0.0f)
                kept[set->id[i]] = {{places[i].x, places[i].y, places[i].z, colors[i].x, colors[i].y,
                                     colors[i].z, colors[i].w, places[i].w}};
        return kept;
    }

    void expect_like_engine(const LookCase& c) {
        SCOPED_TRACE(c.name);
        auto set = std::make_shared<SplatSet>(*test::cloud(count, 3));
        Look look = with_radius();
        LookInputs inputs;
        inputs.seed = 99;
        c.set_up(*set, look, inputs);
        const ShadedSplats engine = apply_look(*set, look, inputs);
        const auto gpu = run(set, look, inputs);
        ASSERT_GT(engine.size(), count / 20) << "the case should show something";
        std::int64_t found_in_both = 0, wrong = 0;
        for (std::size_t i = 0; i < engine.id.size(); ++i) {
            const auto found = gpu.find(engine.id[i]);
            if (found == gpu.end()) continue;
            ++found_in_both;
            const glm::vec3 &p = engine.position[i], &rgb = engine.color[i];
            const float expected[8] = {p.x, p.y, p.z, rgb.x, rgb.y, rgb.z, engine.alpha[i], engine.radius[i]};
            for (int k = 0; k < 8; ++k) {
                const float allowed = std::max(1e-6f, 1e-5f * std::fabs(expected[k]));
                if (!(std::fabs(found->second.values[k] - expected[k]) <= allowed)) {
                    ++wrong;
                    EXPECT_NEAR(found->second.values[k], expected[k], allowed) << "value " << k;
                    if (wrong > 3) return;
                }
            }
        }
        const std::int64_t only_engine = engine.size() - found_in_both;
        const std::int64_t only_gpu = std::int64_t(gpu.size()) - found_in_both;
        EXPECT_LE(only_engine + only_gpu, count / 10000);
    }
};

TEST_F(GpuLook, EveryOperatorAsTheEngine) {
    for (const LookCase& c : all_cases()) expect_like_engine(c);
}

/// Every number of the struct has a value of its own.
LookUniforms numbered_look() {
    LookUniforms u;
    static_assert(sizeof(LookUniforms) % 4 == 0);
    for (std::size_t i = 0; i < sizeof u / 4; ++i) {
        const auto value = std::uint32_t(i + 1);
        std::memcpy(reinterpret_cast<char*>(&u) + 4 * i, &value, 4);
    }
    return u;
}

template <class T>
void put_numbers(std::map<std::string, std::vector<std::uint32_t>>& names, const std::string& name,
                 const T& member) {
    std::vector<std::uint32_t> words(sizeof(T) / 4);
    std::memcpy(words.data(), &member, sizeof(T));
    names[name] = words;
}

void put_profile(std::map<std::string, std::vector<std::uint32_t>>& names, const std::string& name,
                 const LookProfile& p) {
    put_numbers(names, name + ".shape", p.shape);
    put_numbers(names, name + ".rate", p.rate);
    put_numbers(names, name + ".curve.count", p.curve.count);
    put_numbers(names, name + ".curve.knots[0]", p.curve.knots[0]);
}

/// Members by the names OpenGL gives them. Those of arrays of structures, with their index.
std::map<std::string, std::vector<std::uint32_t>> members_of(const LookUniforms& u) {
    std::map<std::string, std::vector<std::uint32_t>> names;
    const auto put = [&](const char* name, const auto& member) {
        put_numbers(names, std::string("look.") + name, member);
    };
    put("seed", u.seed), put("axis", u.axis), put("reach", u.reach), put("density", u.density);
    put("stop_count", u.stop_count), put("noise_count", u.noise_count), put("crop_count", u.crop_count);
    put("absorbs", u.absorbs), put("match", u.match), put("vertical_reach", u.vertical_reach);
    put("alpha.threshold", u.alpha.threshold), put("alpha.power", u.alpha.power);
    put("alpha.gain", u.alpha.gain), put("alpha.unpremultiply", u.alpha.unpremultiply);
    put("radius.smallest", u.radius.smallest), put("radius.largest", u.radius.largest);
    put("radius.horizontal_scale", u.radius.horizontal_scale);
    put("radius.vertical_scale", u.radius.vertical_scale), put("radius.own", u.radius.own);
    put("grade.tint", u.grade.tint), put("grade.black", u.grade.black);
    put("grade.saturation", u.grade.saturation), put("grade.inverse_gamma", u.grade.inverse_gamma);
    put_profile(names, "look.vertical", u.vertical);
    for (int k = 0; k < shared_types::LOOK_MAX_STOPS; ++k) {
        const std::string stop = "stops[" + std::to_string(k) + "]";
        put((stop + ".color").c_str(), u.stops[k].color);
        put((stop + ".scale").c_str(), u.stops[k].scale);
        put((stop + ".column").c_str(), u.stops[k].column);
        put_profile(names, "look." + stop + ".pdf", u.stops[k].pdf);
    }
    for (int k = 0; k < shared_types::LOOK_MAX_NOISES; ++k) {
        const auto& n = u.noises[k];
        const std::string noise = "noises[" + std::to_string(k) + "].";
        const auto put_noise = [&](const char* name, const auto& member) {
            put((noise + name).c_str(), member);
        };
        put_noise("frequency", n.frequency), put_noise("lacunarity", n.lacunarity), put_noise("gain", n.gain);
        put_noise("scale", n.scale), put_noise("octaves", n.octaves), put_noise("seed", n.seed);
        put_noise("cull", n.cull), put_noise("silhouette", n.silhouette), put_noise("jitter", n.jitter);
        put_noise("alpha", n.alpha), put_noise("brightness", n.brightness);
    }
    return names;
}

TEST_F(GpuLook, EveryMemberArrivesWhereOpenGlLooksForIt) {
    const LookUniforms look = numbered_look();
    for (const LookLimits& limits : {LookLimits{}, LookLimits{3, 2, 16, 4}, LookLimits{1, 1, 1, 0}}) {
        const GlProgram program(LookPass::source_for(limits));
        const auto* const block = reinterpret_cast<const std::byte*>(&look);
        GLint size = 0;
        glGetActiveUniformBlockiv(program.name(), glGetUniformBlockIndex(program.name(), "LookBlock"),
                                  GL_UNIFORM_BLOCK_DATA_SIZE, &size);
        EXPECT_EQ(sizeof look, std::size_t(size));
        for (const auto& [name, words] : members_of(look)) {
            const char* pointer = name.c_str();
            GLuint index = GL_INVALID_INDEX;
            glGetUniformIndices(program.name(), 1, &pointer, &index);
            ASSERT_NE(index, GL_INVALID_INDEX) << name;
            GLint offset = -1;
            glGetActiveUniformsiv(program.name(), 1, &index, GL_UNIFORM_OFFSET, &offset);
            ASSERT_LE(std::size_t(offset) + 4 * words.size(), sizeof look) << name;
            EXPECT_EQ(std::memcmp(block + offset, words.data(), 4 * words.size()), 0) << name;
        }
    }
}

TEST(LookLimits, HoldTheLook) {
    LookUniforms look{};
    look.stop_count = 1;
    EXPECT_EQ(limits_for(look), (LookLimits{1, 1, 1, 0, 0}));
    look.stop_count = 4;
    look.noise_count = 3;
    look.crop_count = 5;
    look.noises[2].octaves = 7;
    look.stops[3].pdf.shape = shared_types::PROFILE_CURVE;
    EXPECT_EQ(limits_for(look), LookLimits{});
}

}  // namespace
}  // namespace astrosplat
