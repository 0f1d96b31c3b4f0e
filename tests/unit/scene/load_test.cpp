// Loading: every key, precedence, paths, --set, tracks.

#include <clocale>

#include "scene/layer_setup.h"
#include "scene/toml_text.h"
#include "scene_texts.h"

namespace astrosplat::test {
namespace {

TEST(Load, FullSceneGivesTheDefaults) { EXPECT_EQ(parse(full_scene()), scene_of_defaults()); }

TEST(Load, DescribedKeysAreUnique) {
    std::set<std::string> keys;
    for (const ParameterRow& row : parameter_rows())
        EXPECT_TRUE(keys.insert(row.spec.key).second) << row.spec.key;
}

TEST(Load, DefaultsLieInTheirRangeAndHaveWords) {
    for (const ParameterRow& row : parameter_rows()) {
        EXPECT_FALSE(row.spec.label.empty()) << row.spec.key;
        ASSERT_FALSE(row.spec.help.empty()) << row.spec.key;
        EXPECT_EQ(row.spec.help.back(), '.') << row.spec.key;
        EXPECT_LT(row.spec.slider_min, row.spec.slider_max) << row.spec.key;
        EXPECT_TRUE(row.spec.scale == Scale::linear || row.spec.slider_min > 0.0) << row.spec.key;
    }
}

TEST(Load, IntegersAreNumbersAndWholeFloatsAreIntegers) {
    const Scene scene = parse(small_scene("[layer.look]\ndensity = 2") + "count = 3e6\n");
    EXPECT_EQ(scene.layers[0].look.density, 2.0f);
    EXPECT_EQ(scene.layers[0].source.count, 3000000);
}

TEST(Load, SeveralWaysToWriteOneValue) {
    const Scene scene = parse(small_scene() +
                              "buffer = 2\nhdu = 3\nunpremultiply = true\nblack = 1\nvoxels = [10, 20, 30]\n"
                              "[output]\ndepth = 16\n[layer.look.noise]\ncull = 0.5\n");
    const SourceParams& source = scene.layers[0].source;
    EXPECT_EQ(source.buffer, glm::dvec3(2.0));
    EXPECT_EQ(source.texture.hdu, "3");
    EXPECT_EQ(source.texture.unpremultiply, TextureSettings::Unpremultiply::yes);
    EXPECT_EQ(source.texture.black, 1.0);
    EXPECT_EQ(source.voxels, glm::i64vec3(10, 20, 30));
    EXPECT_EQ(scene.output.depth, OutputParams::Depth::uint16);
    ASSERT_EQ(scene.layers[0].look.noise.size(), 1u);
    EXPECT_EQ(scene.layers[0].look.noise[0].cull, 0.5f);
}

TEST(Load, ListsOfTablesInEitherForm) {
    const Scene inline_form = parse(small_scene("[layer.look]\nnoise = [{ cull = 0.5 }, { jitter = 0.1 }]"));
    const Scene header_form =
        parse(small_scene("[[layer.look.noise]]\ncull = 0.5\n[[layer.look.noise]]\njitter = 0.1"));
    EXPECT_EQ(inline_form, header_form);
    EXPECT_EQ(inline_form.layers[0].look.noise[1].jitter, 0.1f);
}

TEST(Load, ThreePicturesMakeOne) {
    const Scene scene = parse(
        "astrosplat = 1\n[[layer]]\nname = \"a\"\nsource.meshes = { mesh = \"sphere\", texture = "
        "[\"r.fits\", \"g.fits\", \"b.fits\"] }\n",
        {}, "scenes/a.toml");
    const MeshInput& mesh = scene.layers[0].source.meshes.at(0);
    EXPECT_EQ(mesh.mesh, "sphere");
    EXPECT_EQ(mesh.texture, (std::vector<fs::path>{"scenes/r.fits", "scenes/g.fits", "scenes/b.fits"}));
}

TEST(Load, StarsAreUnderstood) {
    const Scene scene = parse(
        "astrosplat = 1\n[[layer]]\nname = \"s\"\n[layer.source]\nkind = \"stars\"\n"
        "catalogue = \"hip_main.dat\"\nunit = 2.0\nlimit = 9.5\nzero_point = 3.0\n"
        "along = \"camera\"\ncount = 800000\nspread = 4.0\npsf = 1.5\n");
    EXPECT_EQ(scene.layers[0].source.kind, SourceKind::stars);
    EXPECT_EQ(scene.layers[0].source.stars.catalogue, "hip_main.dat");
    EXPECT_EQ(scene.layers[0].source.stars.psf, 1.5);
    EXPECT_EQ(scene.layers[0].source.count, 800000);
}

// A parsec is 3.26 light years: by the scene's unit, unless the layer has one of its own. Stars of a picture
// lie where that lies.
TEST(Load, StarsTakeTheScenesScaleWhereTheyHaveNone) {
    const auto units_of = [](const char* scale, const char* unit) {
        const Scene scene = parse(std::string("astrosplat = 1\n") + scale +
                                  "[[layer]]\nname = \"s\"\n[layer.source]\nkind = \"stars\"\n"
                                  "catalogue = \"hip_main.dat\"\n" +
                                  unit);
        return source_of(scene, scene.layers[0]).stars.unit;
    };
    const char* const scaled = "[scene]\nlight_years_per_unit = 100.0\n";
    EXPECT_EQ(units_of("", ""), 1.0);
    EXPECT_EQ(units_of("", "unit = 3.0\n"), 3.0);
    EXPECT_EQ(units_of(scaled, "unit = 3.0\n"), 3.0);
    EXPECT_DOUBLE_EQ(*units_of(scaled, ""), 0.03261563777);
    EXPECT_DOUBLE_EQ(*units_of(scaled, "unit = \"auto\"\n"), 0.03261563777);
    EXPECT_DOUBLE_EQ(*units_of(scaled, "along = \"camera\"\n"), 0.03261563777);
    EXPECT_EQ(units_of("[scene]\nlight_years_per_unit = 1e12\n", ""), 1e-9) << "the least that the key takes";
    Scene scene = parse(small_scene());
    scene.light_years_per_unit = 100.0;
    EXPECT_EQ(parsec_of(scene, scene.layers[0]), 1.0) << "it has no stars of a catalogue";
    EXPECT_EQ(source_of(scene, scene.layers[0]), scene.layers[0].source);
    scene.layers[0].source.kind = SourceKind::stars;
    scene.layers[0].source.stars.like = "other";
    EXPECT_EQ(parsec_of(scene, scene.layers[0]), 1.0);
    EXPECT_NE(message("astrosplat = 1\n[scene]\nlight_years_per_unit = -1.0\n"), "");
}

TEST(Load, SetTakesFractionsAsPeopleWriteThem) {
    const TempFolder folder;
    const fs::path file = folder.file("s.toml", small_scene());
    const auto power = [&](const char* text) {
        return load_scene(file, std::vector<Assignment>{{"layer.stars.look.alpha.power", text}})
            .layers[0]
            .look.alpha.power;
    };
    EXPECT_EQ(power(".5"), 0.5f);
    EXPECT_EQ(power("5."), 5.0f);
    EXPECT_EQ(power("+.25"), 0.25f);
    EXPECT_THROW(power("0.5.1"), InputError);
    EXPECT_EQ(load_scene(file, std::vector<Assignment>{{"provenance.title", ".5"}}).provenance.title, ".5");
}

TEST(Load, PrecedenceIsDefaultsPresetSceneSet) {
    const TempFolder folder;
    folder.file("looks/p.toml",
                "[look]\nalpha = { power = 2.0, gain = 2.0, threshold = 0.5 }\nthickness.map = \"m.png\"\n"
                "thickness.keys = [{ scale = 2.0 }]\n[render]\nopacity = 0.5\n");
    const fs::path file = folder.file(
        "s.toml", small_scene("preset = \"looks/p.toml\"\nlook.alpha = { power = 3.0, gain = 3.0 }"));
    const std::vector<Assignment> assignments{{"layer.stars.look.alpha.power", "4"}};
    const Scene scene = load_scene(file, assignments);
    const LayerParams& layer = scene.layers[0];
    EXPECT_EQ(layer.look.alpha.power, 4.0f);      // --set
    EXPECT_EQ(layer.look.alpha.gain, 3.0f);       // scene
    EXPECT_EQ(layer.look.alpha.threshold, 0.5f);  // preset
    EXPECT_EQ(layer.look.density, 1.0f);          // default
    EXPECT_EQ(layer.render.opacity, 0.5f);
    EXPECT_EQ(layer.look.thickness.map, folder.path() / "looks/m.png")
        << "a preset's paths are relative to the preset";
}

TEST(Load, SetChoosesThePresetBeforeTheSceneSpeaks) {
    const TempFolder folder;
    const fs::path a = folder.file("a.toml", "[look]\nreach = 1.0\ndensity = 0.5\n");
    const fs::path b = folder.file("b.toml", "[look]\nreach = 2.0\ndensity = 0.25\n");
    const fs::path file = folder.file("s.toml", small_scene("preset = \"a.toml\"\nlook.density = 0.75"));
    const std::vector<Assignment> assignments{{"layer.stars.preset", b.string()}};
    const Scene scene = load_scene(file, assignments);
    EXPECT_EQ(scene.layers[0].look.reach, 2.0f);
    EXPECT_EQ(scene.layers[0].look.density, 0.75f);
    EXPECT_EQ(scene.layers[0].preset, b);
}

TEST(Load, DomeIsAPresetThatTheSceneWinsOver) {
    const TempFolder folder;
    folder.file("dome.toml", "astrosplat = 1\n[[layer]]\nname = \"a scene beside this one\"\n");
    const fs::path file = folder.file(
        "s.toml", "astrosplat = 1\n[camera]\nfisheye_tilt = 20.0\n[output]\nfps = 60.0\npreset = \"dome\"\n");
    const Scene scene = load_scene(file);
    EXPECT_EQ(scene.output.width, 4096);  // preset
    EXPECT_EQ(scene.output.height, 4096);
    EXPECT_EQ(scene.camera.projection, Projection::fisheye);
    EXPECT_EQ(scene.camera.fisheye_fov, 180.0);
    EXPECT_EQ(scene.camera.fisheye_tilt, 20.0);  // scene
    EXPECT_EQ(scene.output.fps, 60.0);
    EXPECT_EQ(scene.output.pixel_filter, 0.5);  // default
    EXPECT_EQ(load_scene(file, std::vector<Assignment>{{"output.resolution", "[1024, 1024]"}}).output.width,
              1024);
}

TEST(Load, SetMakesAnySceneADome) {
    const std::string flat =
        small_scene() + "[output]\nresolution = [640, 480]\n[camera]\nprojection = \"orthographic\"\n";
    const Scene scene = parse(flat, {"output.preset=dome", "camera.fisheye_tilt=90"});
    EXPECT_EQ(scene.output.width, 4096);
    EXPECT_EQ(scene.output.height, 4096);
    EXPECT_EQ(scene.camera.projection, Projection::fisheye);
    EXPECT_EQ(scene.camera.fisheye_tilt, 90.0);
}

TEST(Load, OutputPresetsOfOnesOwnHaveAnEnding) {
    const TempFolder folder;
    folder.file("wall.toml", "[output]\nresolution = [7680, 1080]\n[camera]\nfov = 20.0\n");
    const fs::path file = folder.file("s.toml", "astrosplat = 1\n[output]\npreset = \"wall.toml\"\n");
    EXPECT_EQ(load_scene(file).output.width, 7680);
    EXPECT_EQ(load_scene(file).camera.fov, 20.0);
    folder.file("wall.toml", "[look]\ndensity = 0.5\n");
    EXPECT_THROW(load_scene(file), InputError);
}

TEST(Load, PathsAreRelativeToTheFileAndKnowTheEnvironment) {
    const Variable folder("ASTROSPLAT_TEST_FOLDER", "/data/n\xC3\xA4he");
    const Scene scene = parse(small_scene() +
                                  "[environment]\nimage = \"${ASTROSPLAT_TEST_FOLDER}/sky.exr\"\n"
                                  "[output]\npath = \"${ASTROSPLAT_TEST_FOLDER}/f.####.png\"\n",
                              {"layer.stars.source.file=cam.pda"}, "scenes/a.toml");
    EXPECT_EQ(scene.environment.image, "/data/n\xC3\xA4he/sky.exr");
    EXPECT_EQ(scene.output.path, "/data/n\xC3\xA4he/f.####.png");
    EXPECT_EQ(scene.layers[0].source.meshes[0].texture[0], "scenes/a.png");
    EXPECT_EQ(scene.layers[0].source.meshes[0].mesh, "plane") << "built-in names are no paths";
    EXPECT_EQ(scene.layers[0].source.file, "cam.pda") << "--set is relative to the working directory";
    EXPECT_EQ(parse(small_scene(), {"output.path=x/f.####.exr"}).output.path,
              (fs::current_path() / "x/f.####.exr").string());
}

TEST(Load, SetTakesBareWordsAsText) {
    const Scene scene =
        parse(small_scene(), {"output.frames=1-10,20", "provenance.title = M 51, 2005-01-01",
                              "provenance.credit=1984", "layer.stars.render.blend=add",
                              "layer.stars.visible=false", "layer.stars.source.meshes.0.texture=b.png",
                              "layer.stars.look.noise.cull=0.5", "layer.stars.look.noise.1.jitter=0.25",
                              "camera.position=[1,2,3]", "layer.stars.look.grade={gain=2.0, gamma=1.5}"});
    EXPECT_EQ(scene.output.frames, "1-10,20");
    EXPECT_EQ(scene.provenance.title, "M 51, 2005-01-01");
    EXPECT_EQ(scene.provenance.credit, "1984");
    EXPECT_EQ(scene.layers[0].render.blend, Blend::add);
    EXPECT_FALSE(scene.layers[0].visible);
    EXPECT_EQ(scene.layers[0].source.meshes[0].texture[0], "b.png");
    ASSERT_EQ(scene.layers[0].look.noise.size(), 2u);
    EXPECT_EQ(scene.layers[0].look.noise[0].cull, 0.5f);
    EXPECT_EQ(scene.layers[0].look.noise[1].jitter, 0.25f);
    EXPECT_EQ(scene.camera.position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(scene.layers[0].look.grade.gamma, 1.5f);
}

TEST(Load, SetReachesEveryParameter) {
    Scene scene = parse(full_scene());
    for (const Parameter& parameter : describe(scene).parameters) {
        const std::string assignment = parameter.spec.key.text() + "=" + to_toml(parameter.get());
        if (parameter.spec.key == "layer.stars.preset" || parameter.spec.key == "output.preset")
            continue;  // "" is no file
        EXPECT_EQ(message(full_scene(), {assignment}), "") << assignment;
    }
}

TEST(Load, ListsWithinLists) {
    const std::string head = small_scene();
    const auto masks = [&](const std::string& line, std::vector<std::string> assignments = {}) {
        return parse(head + line + "\n", std::move(assignments)).layers[0].source.texture.mask;
    };
    const std::vector<MaskParams> both =
        masks("mask = [{ feather = 0.1 }, { any = [{ invert = true }, { turn = 5 }] }]");
    ASSERT_EQ(both.size(), 2u);
    EXPECT_EQ(both[0].feather, 0.1);
    ASSERT_EQ(both[1].any.size(), 2u);
    EXPECT_TRUE(both[1].any[0].invert);
    EXPECT_EQ(both[1].any[1].turn, 5.0);
    const std::vector<MaskParams> bare = masks("mask = { any = { turn = 5 } }");
    ASSERT_EQ(bare.size(), 1u);
    ASSERT_EQ(bare[0].any.size(), 1u);
    EXPECT_EQ(bare[0].any[0].turn, 5.0);
    const std::vector<MaskParams> set =
        masks("", {"layer.stars.source.mask.0.any.0.turn=3", "layer.stars.source.mask.0.any.1.turn=4"});
    ASSERT_EQ(set.size(), 1u);
    ASSERT_EQ(set[0].any.size(), 2u);
    EXPECT_EQ(set[0].any[1].turn, 4.0);
}

TEST(Load, SetWinsOverAnimation) {
    const std::string text = small_scene() + "[animation]\n\"camera.fov\" = { keys = [[1, 20], [9, 40]] }\n";
    EXPECT_EQ(parse(text).animation.size(), 1u);
    const Scene scene = parse(text, {"camera.fov=30"});
    EXPECT_TRUE(scene.animation.empty());
    EXPECT_EQ(scene.camera.fov, 30.0);
    EXPECT_EQ(parse(text, {"animation.camera.roll={keys=[[1,0],[2,5]]}"}).animation.size(), 2u);
}

TEST(Load, TracksKeepTheFilesOrderAndTheirSettings) {
    const Scene scene =
        parse(small_scene() +
              "[animation]\n"
              "\"layer.stars.render.blend\" = { keys = [[1, \"over\"], [5, \"hybrid\"]] }\n"
              "\"camera.position\" = { keys = [[1, [0, 0, 30], \"linear\"], [240, [0, 2, 4]]], interpolation "
              "= \"smooth\", ends = \"through\", constant_speed = true }\n"
              "\"layer.stars.look.noise.cull\" = { keys = [[-2.5, 0.25]] }\n");
    ASSERT_EQ(scene.animation.size(), 3u);
    EXPECT_EQ(scene.animation[0].keyframes[1].value, std::vector<double>{4.0});
    const Track& path = scene.animation[1];
    EXPECT_EQ(path.keyframes[0].interpolation, Interpolation::linear);
    EXPECT_EQ(path.keyframes[1].interpolation, Interpolation::smooth);
    EXPECT_EQ(path.keyframes[1].value, (std::vector<double>{0, 2, 4}));
    EXPECT_EQ(path.ends, Ends::through);
    EXPECT_TRUE(path.constant_speed);
    EXPECT_EQ(scene.animation[2].key, "layer.stars.look.noise.0.cull");
    EXPECT_EQ(scene.layers[0].look.noise.size(), 1u);
}

TEST(Load, ACommaLocaleChangesNothing) {
    const CommaLocale comma;
    EXPECT_EQ(parse(small_scene(), {"camera.fov=30.5"}).camera.fov, 30.5);
    EXPECT_EQ(to_toml(Value(0.5)), "0.5");
    EXPECT_EQ(to_toml(Value(1e20)), "1e+20");
    EXPECT_EQ(to_toml(Value(3.0)), "3.0");
}

TEST(Load, FilesWithUmlautsAndBlanks) {
    const TempFolder folder;
    const fs::path file = folder.file("M\xC3\xB6we 1.toml", small_scene());
    EXPECT_EQ(load_scene(file).layers[0].source.meshes[0].texture[0], folder.path() / "a.png");
}

}  // namespace
}  // namespace astrosplat::test
