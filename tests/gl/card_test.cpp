// The renderer on a card against the processor's, bit by bit. Without a card Mesa's llvmpipe runs every pass.
#include "gl/card.h"

#include <glm/matrix.hpp>
#include <regex>
#include <set>

#include "core/parallel.h"
#include "gl/gl_fixture.h"
#include "look/prepare.h"
#include "pipeline.h"
#include "scene/load.h"
#include "splats/splat_set.h"
#include "support/bits.h"
#include "support/quiet.h"
#include "support/temp_folder.h"
#include "support/test.h"
#include "unit/look/cases.h"
#include "unit/render/random_scene.h"

namespace astrosplat::test {
namespace {

class Cards : public GlTest {
  protected:
    static Card& card() {
        const GlInfo& info = shared_context().context->info();
        static Card the_card(info, info.software);
        return the_card;
    }
};

void expect_same(const Image& card, const Image& processor, const std::string& what) {
    ASSERT_EQ(card.pixels.size(), processor.pixels.size()) << what;
    std::size_t differ = 0, first = 0;
    for (std::size_t i = card.pixels.size(); i-- > 0;)
        if (std::memcmp(&card.pixels[i], &processor.pixels[i], sizeof(float)) != 0) ++differ, first = i;
    EXPECT_EQ(differ, 0u) << what << ": value " << first << " is " << card.pixels[first] << ", not "
                          << processor.pixels[first];
}

/// All images of the frame, by the card and by the processor.
void expect_same_frame(Card& card, std::span<const RenderLayer> layers, const Camera& camera,
                       RenderSettings settings, const std::string& what) {
    const RenderedFrame expected = render(layers, camera, nullptr, settings);
    settings.device = &card;
    const RenderedFrame frame = render(layers, camera, nullptr, settings);
    ASSERT_EQ(frame.statistics.not_on_device, "") << what;
    EXPECT_EQ(frame.statistics.device, card.name());
    expect_same(frame.beauty, expected.beauty, what);
    expect_same(frame.depth, expected.depth, what + ", depth");
    expect_same(frame.coverage, expected.coverage, what + ", coverage");
    expect_same(frame.count, expected.count, what + ", count");
    for (std::size_t l = 0; l < expected.layers.size(); ++l)
        expect_same(frame.layers[l], expected.layers[l], what + ", layer " + std::to_string(l));
    EXPECT_EQ(frame.statistics.splats_drawn, expected.statistics.splats_drawn) << what;
    EXPECT_NEAR(frame.statistics.mean_overlap, expected.statistics.mean_overlap,
                0.05 + 0.05 * expected.statistics.mean_overlap)
        << what;
}

Camera cloud_camera(double width, double height) {
    Camera camera;
    camera.eye = {0.0, 0.0, 9.0};
    camera.focal_px = 0.76 * width;
    camera.center_x_px = 0.5 * width;
    camera.center_y_px = 0.5 * height;
    return camera;
}

TEST_F(Cards, EveryBlendAndFalloff) {
    const ShadedSplats splats = cloud(3000, 1);
    for (const Blend blend :
         {Blend::over, Blend::add, Blend::screen, Blend::lighten, Blend::hybrid, Blend::absorb})
        for (const Falloff::Shape shape : all_shapes) {
            const RenderLayer layer = layer_of("layer", splats, blend, shape);
            expect_same_frame(card(), {&layer, 1}, cloud_camera(211, 133), settings_of(211, 133),
                              fmt::format("blend {}, shape {}", int(blend), int(shape)));
        }
}

TEST_F(Cards, RandomScenesWithAllImages) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        RandomScene scene(seed, 400);
        scene.settings.aov_depth = scene.settings.aov_coverage = scene.settings.aov_count = seed % 2 == 0;
        scene.settings.aov_layers = seed % 4 == 0;
        expect_same_frame(card(), scene.layers, scene.camera, scene.settings, fmt::format("seed {}", seed));
    }
}

TEST_F(Cards, SplatsThatTheProcessorProjects) {
    ShadedSplats splats = cloud(500, 8), others = cloud(900, 9, 0.4f), stars = cloud(200, 10);
    for (std::size_t i = 0; i < splats.id.size(); i += 7) splats.id[i] |= star_band << 48;
    for (glm::vec3& color : stars.color) color *= 40.0f;
    for (std::size_t i = 0; i < others.id.size(); ++i)
        others.stretch.push_back(
            {glm::vec3(2.0f, 0.3f, 0.0f), glm::vec3(0.0f, 0.7f, 0.1f), glm::vec3(0.2f, 0.0f, 1.0f)});
    for (const Blend blend : {Blend::over, Blend::add, Blend::screen, Blend::hybrid}) {
        RenderLayer layers[] = {layer_of("divided", splats, blend, Falloff::Shape::gaussian),
                                layer_of("stretched", others, Blend::over, Falloff::Shape::gaussian),
                                layer_of("stars", stars, Blend::add)};
        layers[0].render.lod = {20.0f, 64, 0.7f, 6.0f};
        layers[2].stars = StarPsf{1.0f, 0.2f, 3.0f, 2.5f, 0.1f};
        for (const std::size_t count : {1, 2, 3}) {
            card().set_slabs(count == 3 ? 7 : 1);
            RenderSettings settings = settings_of(211, 133);
            settings.aov_depth = count == 2;
            if (count == 3 || blend == Blend::over)
                expect_same_frame(card(), {layers, count}, cloud_camera(211, 133), settings,
                                  fmt::format("blend {}, {} layers", int(blend), count));
        }
    }
    card().set_slabs(0);
}

/// Children, stars that stay points and what neither becomes either, from within the cloud.
TEST_F(Cards, WhatLevelOfDetailDivides) {
    ShadedSplats splats = cloud(300, 12);
    for (std::size_t i = 0; i < splats.id.size(); i += 5) splats.id[i] |= star_band << 48;
    for (std::size_t i = 1; i < splats.id.size(); i += 9) splats.color[i] = glm::vec3(-0.5f, -1.0f, -2.0f);
    Camera inside = cloud_camera(160, 100);
    inside.eye = {0.3, 0.2, 1.0};
    const LevelOfDetail kinds[] = {
        {9.0f, 256, 0.0f, 0.0f}, {9.0f, 64, 1.3f, 0.0f}, {0.0f, 64, 0.0f, 4.0f}, {12.0f, 8, 0.4f, 2.0f}};
    const auto all = [&](const char* what, const Camera& camera, Blend blend, Falloff::Shape shape,
                         bool holdout) {
        for (const LevelOfDetail& lod : kinds) {
            RenderLayer layers[] = {layer_of("divided", splats, blend, shape),
                                    layer_of("too", splats, Blend::over, Falloff::Shape::linear)};
            layers[0].absorbs = true;
            for (RenderLayer& layer : layers) layer.render.lod = lod;
            layers[0].render.holdout = holdout;
            expect_same_frame(card(), layers, camera, settings_of(160, 100),
                              fmt::format("{}, blend {}, shape {}, {} children, noise {}", what, int(blend),
                                          int(shape), lod.max_children, lod.noise));
        }
    };
    for (const Blend blend : {Blend::over, Blend::add, Blend::screen, Blend::hybrid, Blend::absorb})
        all("outside", cloud_camera(160, 100), blend, Falloff::Shape::gaussian, false);
    all("inside", inside, Blend::hybrid, Falloff::Shape::constant, false);
    all("held out", inside, Blend::screen, Falloff::Shape::exponential, true);
}

TEST_F(Cards, OverAnImage) {
    const ShadedSplats splats = cloud(3000, 11);
    Image sky = make_image(211, 133, 4, 1.0f);
    for (std::size_t i = 0; i < sky.pixels.size(); ++i) sky.pixels[i] = float(i * 37 % 101) / 100.0f;
    for (const Blend blend : {Blend::over, Blend::screen, Blend::absorb}) {
        const RenderLayer layer = layer_of("layer", splats, blend);
        RenderSettings settings = settings_of(211, 133);
        settings.backdrop = &sky;
        expect_same_frame(card(), {&layer, 1}, cloud_camera(211, 133), settings,
                          fmt::format("blend {}", int(blend)));
    }
}

TEST_F(Cards, SlabsAndRegionsChangeNoBit) {
    const ShadedSplats splats = cloud(6000, 3, 0.5f), others = cloud(2000, 4);
    const RenderLayer layers[] = {layer_of("a", splats, Blend::over, Falloff::Shape::gaussian),
                                  layer_of("b", others, Blend::screen, Falloff::Shape::linear)};
    for (const int slabs : {1, 7, 32}) {
        card().set_slabs(slabs);
        for (const std::size_t count : {1, 2}) {
            RenderSettings settings = settings_of(300, 170);
            expect_same_frame(card(), {layers, count}, cloud_camera(300, 170), settings,
                              fmt::format("{} slabs", slabs));
            settings.region = {37, 21, 190, 71};
            expect_same_frame(card(), {layers, count}, cloud_camera(300, 170), settings,
                              fmt::format("{} slabs, a region", slabs));
        }
    }
    card().set_slabs(0);
}

/// Draws layers by a card with a part of the memory that they would take at once; how it did.
Card::Share drawn_with(double share_of_memory, std::span<const RenderLayer> layers,
                       const RenderSettings& settings) {
    const Quiet quiet;
    const GlInfo& info = shared_context().context->info();
    const Camera camera = cloud_camera(double(settings.width), double(settings.height));
    Card roomy(info, info.software), card(info, info.software);
    expect_same_frame(roomy, layers, camera, settings, "all at once");
    EXPECT_FALSE(roomy.share().apart);
    EXPECT_EQ(roomy.share().bands, 1);
    const auto room = std::int64_t(share_of_memory * double(roomy.bytes()));
    card.set_room(room);
    for (const char* what : {"first", "again"})
        expect_same_frame(card, layers, camera, settings, fmt::format("{} of {}", what, share_of_memory));
    EXPECT_LE(card.bytes(), room);
    return card.share();
}

TEST_F(Cards, WhereMemoryIsShortSlabsComeOneByOne) {
    const ShadedSplats splats = cloud(20'000, 12), others = cloud(2000, 13, 0.4f);
    RenderLayer layers[] = {layer_of("a", splats, Blend::over, Falloff::Shape::gaussian),
                            layer_of("b", others, Blend::hybrid, Falloff::Shape::linear)};
    RenderSettings settings = settings_of(96, 54);
    EXPECT_TRUE(drawn_with(0.5, {layers, 1}, settings).apart);
    layers[1].render.lod = {20.0f, 64, 0.7f, 6.0f};
    settings.aov_depth = settings.aov_layers = true;
    EXPECT_TRUE(drawn_with(0.6, layers, settings).apart);
}

TEST_F(Cards, WhereMemoryIsShorterBandsDo) {
    const ShadedSplats splats = cloud(600, 15);
    const RenderLayer layer = layer_of("a", splats, Blend::screen, Falloff::Shape::gaussian);
    RenderSettings settings = settings_of(400, 230);
    EXPECT_GT(drawn_with(0.6, {&layer, 1}, settings).bands, 1);
    settings.aov_layers = settings.aov_count = true;
    settings.region = {31, 17, 311, 190};
    EXPECT_GT(drawn_with(0.6, {&layer, 1}, settings).bands, 1);
}

TEST_F(Cards, WithoutMemoryTheProcessorDraws) {
    const GlInfo& info = shared_context().context->info();
    Card card(info, info.software);
    card.set_room(1'000'000);
    const ShadedSplats splats = cloud(30'000, 14);
    const RenderLayer layer = layer_of("layer", splats);
    RenderSettings settings = settings_of(64, 36);
    settings.device = &card;
    const RenderedFrame frame = render({&layer, 1}, cloud_camera(64, 36), nullptr, settings);
    EXPECT_EQ(frame.statistics.device, "");
    EXPECT_EQ(frame.statistics.not_on_device, "it ran out of memory or was lost");
    settings.device = nullptr;
    expect_same(frame.beauty, render({&layer, 1}, cloud_camera(64, 36), nullptr, settings).beauty, "frame");
}

/// A look that the card applies is the processor's: how many splats it keeps, the largest light, and the
/// pixels.
TEST_F(Cards, LooksAppliedInItsMemory) {
    std::uint64_t stamp = std::uint64_t{1} << 40;
    for (LookCase& c : look_cases()) {
        c.inputs.thickness_map = c.look.thickness.map.empty() ? nullptr : &c.map;
        if (c.look.vertical.match == VerticalAlpha::Match::picture) continue;  // sums over all splats
        const std::uint64_t set_stamp = ++stamp;
        for (const float power : {0.8f, 1.7f}) {  // one look after the other
            c.look.alpha.power = power;
            ShadedSplats shaded = apply_look(c.set, c.look, c.inputs);
            const auto found = card().shade(c.set, set_stamp, prepare_look(c.set, c.look, c.inputs),
                                            c.inputs.thickness_map, ++stamp);
            ASSERT_EQ(found.has_value(), c.name != "everything, and outlines") << c.name;
            if (!found) continue;  // outlines are the processor's
            EXPECT_EQ(found->kept, shaded.size()) << c.name;
            float largest[2] = {};
            for (std::size_t i = 0; i < shaded.id.size(); ++i) {
                const glm::vec3& light = shaded.color[i];
                float& most = largest[is_star(shaded.id[i])];
                most = std::max(most, shaded.alpha[i] * std::max({light.x, light.y, light.z}));
            }
            EXPECT_EQ(found->largest_light, largest[0]) << c.name;
            EXPECT_EQ(found->largest_star_light, largest[1]) << c.name;
            const DeviceSplats there{stamp,      c.set.size(), found->kept,
                                     largest[0], largest[1],   [&] { return &shaded; }};
            for (const Blend blend : {Blend::over, Blend::screen}) {
                RenderLayer layer = layer_of("layer", shaded, blend, Falloff::Shape::gaussian);
                layer.absorbs = c.set.absorbs;
                const RenderSettings of_processor = settings_of(160, 90);
                RenderSettings settings = of_processor;
                settings.device = &card();
                const Camera camera = cloud_camera(160, 90);
                const RenderedFrame expected = render({&layer, 1}, camera, nullptr, of_processor);
                layer.splats = nullptr;
                layer.on_device = &there;
                const RenderedFrame frame = render({&layer, 1}, camera, nullptr, settings);
                EXPECT_EQ(frame.statistics.device, card().name()) << c.name;
                expect_same(frame.beauty, expected.beauty, c.name);
                if (c.name != "defaults" || power > 1.0f || blend != Blend::over) continue;
                layer.on_device = &there;  // divided there too: the processor has none of their rows
                layer.render.lod = {3.0f, 16, 0.5f, 0.0f};
                const RenderedFrame divided = render({&layer, 1}, camera, nullptr, settings);
                EXPECT_EQ(divided.statistics.device, card().name()) << c.name;
                layer.on_device = nullptr;
                layer.splats = &shaded;
                expect_same(divided.beauty, render({&layer, 1}, camera, nullptr, of_processor).beauty,
                            c.name + ", divided");
            }
        }
    }
}

/// The pipeline's way: one look after the other, and one that the set cannot have.
TEST_F(Cards, LooksThatMoveInAScene) {
    SplatSet made = file_set(2000);
    for (std::size_t i = 1900; i < 2000; ++i) made.id[i] |= star_band << 48;  // stars, which stay points
    const auto set = std::make_shared<const SplatSet>(std::move(made));
    Scene scene = parse_scene(R"(astrosplat = 1
[output]
resolution = [96, 54]
[camera]
position = [0.0, 4.0, 9.0]
target = [0.0, 0.0, 0.0]
[[layer]]
name = "dust"
source = { kind = "splats", file = "dust.splats" }
[layer.look]
noise = [ { frequency = 0.7, octaves = 4, cull = 0.5 } ]
[layer.render]
lod = { max_px = 900.0, noise = 0.5, star_distance = 30.0 }
)",
                              "/scene.toml");
    Pipeline there, here;
    const auto beauty_of = [&](Pipeline& pipeline, RenderDevice* device) {
        pipeline.set_scene(scene, {set});
        const FrameScene now = pipeline.frame_scene(1.0);
        RenderSettings settings = render_settings(now.scene.output);
        settings.device = device;
        const RenderedFrame frame = pipeline.frame(now, settings);
        EXPECT_EQ(frame.statistics.device, device ? card().name() : "");
        return frame.beauty;
    };
    for (const float gain : {1.0f, 0.5f, 1.0f, 2.0f}) {
        scene.layers[0].look.grade.gain = gain;
        expect_same(beauty_of(there, &card()), beauty_of(here, nullptr), fmt::format("gain {}", gain));
        EXPECT_EQ(there.statistics()[0].drawn, here.statistics()[0].drawn);
    }
    expect_same(beauty_of(there, nullptr), beauty_of(here, nullptr), "made by the processor again");
    scene.layers[0].look.vertical = {VerticalAlpha::Shape::linear, 3.0f, {}, 0.0f, VerticalAlpha::Match::sum};
    const std::string refusal = ERROR_OF(beauty_of(here, nullptr));
    EXPECT_HAS(refusal, "dust");
    EXPECT_EQ(ERROR_OF(beauty_of(there, &card())), refusal);
}

TEST_F(Cards, WhatACardDoesNotDrawTheProcessorDoes) {
    const ShadedSplats splats = cloud(100, 5);
    RenderLayer layer = layer_of("layer", splats);
    Camera camera = cloud_camera(64, 36);
    camera.projection = Projection::equirectangular;
    RenderSettings settings = settings_of(64, 36);
    settings.device = &card();
    const RenderedFrame frame = render({&layer, 1}, camera, nullptr, settings);
    EXPECT_EQ(frame.statistics.device, "");
    EXPECT_EQ(frame.statistics.not_on_device, "it draws no projections onto the sphere");
    settings.device = nullptr;
    expect_same(frame.beauty, render({&layer, 1}, camera, nullptr, settings).beauty, "sphere");
}

TEST_F(Cards, DenormalLightIsNone) {
    ShadedSplats splats = cloud(2000, 6);
    for (float& alpha : splats.alpha) alpha *= 1e-38f;
    const RenderLayer layer = layer_of("layer", splats, Blend::over, Falloff::Shape::gaussian);
    expect_same_frame(card(), {&layer, 1}, cloud_camera(160, 90), settings_of(160, 90), "alpha 1e-38");
}

/// The picture by a card whose programs have other text.
Image faulty_picture(const std::string& from, const std::string& to) {
    const GlInfo& info = shared_context().context->info();
    Card card(info, info.software);
    int found = 0;
    card.set_edit([&](std::string& text) {
        for (std::size_t at = text.find(from); at != std::string::npos;
             at = text.find(from, at + to.size())) {
            text.replace(at, from.size(), to);
            ++found;
        }
    });
    card.set_slabs(7);
    ShadedSplats splats = cloud(3000, 7, 0.5f);
    for (std::size_t i = 1; i < splats.id.size(); i += 2) splats.position[i] = splats.position[i - 1];
    RenderLayer layer = layer_of("layer", splats, Blend::over, Falloff::Shape::gaussian);
    RenderSettings settings = settings_of(120, 70);
    settings.device = &card;
    const RenderedFrame frame = render({&layer, 1}, cloud_camera(120, 70), nullptr, settings);
    EXPECT_GT(found, 0) << from;
    EXPECT_EQ(frame.statistics.not_on_device, "");
    return frame.beauty;
}

TEST_F(Cards, AFaultInAnyPassShows) {
    const Image right = faulty_picture("uint lower = same", "uint lower = same");
    const std::pair<const char*, const char*> faults[] = {
        {"uint lower = same & ((1u << lane) - 1u);",
         "uint lower = same & ~((2u << lane) - 1u);"},  // order of equals
        {"(slabs + 1u) + slab], end = range[tile * (slabs + 1u) + slab + 1u];",
         "(slabs + 1u) + 6u - slab], end = range[tile * (slabs + 1u) + 7u - slab];"},  // slabs turned
        {"floor(px * 256.0f + 0.5f)", "floor(px * 256.0f)"},
        {"p.through >= stop", "p.through >= 0.5f"},
        {"group_begin[group] + e;", "group_begin[group] + e + 1u;"}};
    for (const auto& [from, to] : faults) EXPECT_NE(faulty_picture(from, to).pixels, right.pixels) << from;
}

/// Of a compute program, by the reference compiler: operations on floats, and those that a compiler may
/// contract.
struct Operations {
    int divisions = 0, loose = 0;
};
Operations operations_of(const std::string& text) {
    const TempFolder folder;
    const std::string listing = folder.path() / "listing.txt",
                      file = folder.file("program.comp", text).string();
    const std::string command =
        "glslangValidator -G --aml -H -o /dev/null '" + file + "' > '" + listing + "' 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << bytes_of(listing);
    std::istringstream lines(bytes_of(listing));
    const std::regex fixed(R"(Decorate (\d+)(\(\S*\))? NoContraction)"),
        operation(R"((\d+)(\(\S*\))?:.*\b(FAdd|FSub|FMul|FDiv|Dot|VectorTimesScalar)\b.*)");
    std::set<std::string> exact;
    Operations found;
    std::smatch parts;
    for (std::string line; std::getline(lines, line);) {
        if (std::regex_search(line, parts, fixed)) exact.insert(parts[1]);
        if (!std::regex_search(line, parts, operation)) continue;
        found.divisions += parts[3] == "FDiv";
        found.loose += !exact.contains(parts[1]);
    }
    return found;
}

TEST(CardPrograms, NothingMayBeContractedAndDivisionHasAName) {
    if (std::system("glslangValidator --version > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "glslangValidator is not installed (glslang-tools)";
    const std::pair<const char*, const char*> programs[] = {{"card_project.glsl", "PASS 2"},
                                                            {"card_project.glsl", "PASS 3"},
                                                            {"card_children.glsl", "PASS 0"},
                                                            {"card_children.glsl", "PASS 1"},
                                                            {"card_project.glsl", "PASS 3,ANY,RANKS"},
                                                            {"card_project.glsl", "PASS 3,ANY,GIVEN"},
                                                            {"card_look.glsl", ""},
                                                            {"card_fold.glsl", "KIND 0"},
                                                            {"card_fold.glsl", "KIND 1"},
                                                            {"card_fold.glsl", "KIND 2,SCREEN"},
                                                            {"card_fold.glsl", "KIND 2,ANY,SHAPED"},
                                                            {"card_fold.glsl", "KIND 3,ANY"}};
    for (const auto& [file, defines] : programs) {
        ProgramSource source = card_source(file, defines, false);
        const Operations found = operations_of(compute_text(source));
        EXPECT_EQ(found.loose, 0) << file << " " << defines;
        EXPECT_LE(found.divisions, 2) << file << " " << defines << ": those of as_div";
        source.edit = [](std::string& text) {
            for (std::size_t at; (at = text.find("precise ")) != std::string::npos;) text.erase(at, 8);
        };
        EXPECT_GT(operations_of(compute_text(source)).loose, 0) << "the test can fail";
    }
}

TEST(MadePrecise, LocalsResultsAndWhatComesOut) {
    EXPECT_EQ(made_precise("struct A { float x; };\n"
                           "float f(float a, inout A b) {\n"
                           "    float c = a * a, d = 1.0f;  // float e;\n"
                           "    if (c > d) return c;\n"
                           "    return c\n        + d;\n"
                           "}\n"
                           "void g() { A a; uint n = 1u; return; }\n"),
              "struct A { float x; };\n"
              "float f(float a, precise inout A b) {\n"
              "    precise float c = a * a, d = 1.0f;  // float e;\n"
              "    if (c > d) { precise float result_ = c; return result_; }\n"
              "    { precise float result_ = c\n        + d; return result_; }\n"
              "}\n"
              "void g() { precise A a; uint n = 1u; return; }\n");
}

}  // namespace
}  // namespace astrosplat::test
