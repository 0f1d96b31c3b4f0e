// The list of layers, and every parameter of the description, as they are edited; and first scenes, of files
// that are dropped.
#include "edit/layers.h"

#include "edit/document.h"
#include "edit/edits.h"
#include "edit/layer_steps.h"
#include "scenes.h"
#include "source/textured_mesh.h"
#include "splat_files/splat_file.h"
#include "support/capture.h"
#include "support/random_values.h"
#include "support/test.h"
#include "support/test_data.h"

namespace astrosplat {
namespace {

// The list of layers: names, order, copies, and tracks that follow them.

struct Layers : testing::Test {
    Scene scene = parse_scene(test::edit_scene, "/scene.toml");

    std::vector<std::string> names() const { return layer_names(scene); }
    using Names = std::vector<std::string>;
};

TEST_F(Layers, FreeNames) {
    EXPECT_EQ(free_layer_name(scene, "gas"), "gas");
    EXPECT_EQ(free_layer_name(scene, "dust"), "dust_2");
    EXPECT_EQ(free_layer_name(scene, "M 51 (rot)"), "M_51_rot");
    EXPECT_EQ(free_layer_name(scene, "51"), "layer");
    EXPECT_EQ(free_layer_name(scene, "ä"), "layer");
    scene.layers[0].name = "dust_2";
    EXPECT_EQ(free_layer_name(scene, "dust_2"), "dust_2_2");
}

// Copied text, between scenes.

TEST_F(Layers, ACopiedLayerComesWithItsKeyframesAndFiles) {
    Scene other = parse_scene(test::inclined_scene, "/elsewhere/other.toml");
    const std::string text = copied_text(scene, CopiedKind::layer, 0);
    EXPECT_EQ(copied_kind(text), CopiedKind::layer);
    EXPECT_EQ(paste_text(other, text, 0), 1u);
    ASSERT_EQ(other.layers.size(), 2u);
    EXPECT_EQ(other.layers[1], scene.layers[0]) << "paths, too: /Bilder/m 51 ä.png";
    EXPECT_EQ(other.animation.back().key, "layer.dust.look.noise.1.jitter");
    EXPECT_EQ(paste_text(other, text, 0), 1u) << "again, above the selected one";
    EXPECT_EQ(other.layers[1].name, "dust_2");
    EXPECT_EQ(other.animation.back().key, "layer.dust_2.look.noise.1.jitter");
    check_edited_scene(other, "other");
    Scene empty;
    EXPECT_EQ(paste_text(empty, text, 0), 0u);
}

TEST_F(Layers, ACopiedLookTakesTheLooksPlace) {
    paste_text(scene, copied_text(scene, CopiedKind::look, 0), 1);
    EXPECT_EQ(scene.layers[1].look, scene.layers[0].look);
    EXPECT_EQ(scene.layers[1].render, scene.layers[0].render);
    EXPECT_EQ(scene.layers[1].source.kind, SourceKind::splats) << "the rest is its own";
    EXPECT_TRUE(is_animated(scene, "layer.stars.look.noise.1.jitter"));
    EXPECT_FALSE(is_animated(scene, "layer.stars.render.core")) << "keyframes of the look before";
}

TEST_F(Layers, ACopiedCameraTakesTheCamerasPlace) {
    set_keyframe(scene, "camera.fov", 3.0, 30.0);
    Scene from = parse_scene(test::inclined_scene, "/a/b.toml");
    set_keyframe(from, "camera.roll", 7.0, 12.0);
    EXPECT_EQ(paste_text(scene, copied_text(from, CopiedKind::camera, 0), 1), 1u);
    EXPECT_EQ(scene.camera, from.camera);
    EXPECT_TRUE(has_keyframe_at(scene, "camera.roll", 7.0));
    EXPECT_FALSE(is_animated(scene, "camera.fov"));
    EXPECT_TRUE(is_animated(scene, "layer.stars.render.core"));
}

TEST_F(Layers, OtherTextIsNotPasted) {
    EXPECT_EQ(ERROR_OF(paste_text(scene, "hello", 0)),
              "Paste: expected a layer, look or camera that was copied, found another text");
    EXPECT_FALSE(copied_kind(""));
    const std::string look = copied_text(scene, CopiedKind::look, 0);
    EXPECT_EQ(ERROR_OF(paste_text(scene, look.substr(0, look.find('\n') + 1) + "astrosplat = 1\n", 0)),
              "Paste: expected a layer in the copied text, found none");
    Scene empty;
    EXPECT_EQ(ERROR_OF(paste_text(empty, look, 0)),
              "Paste: expected a layer that takes the look, found none");
}

TEST_F(Layers, Duplicate) {
    EXPECT_EQ(duplicate_layer(scene, 1), 2u);
    EXPECT_EQ(names(), (Names{"dust", "stars", "stars_2"}));
    LayerParams copy = scene.layers[2];
    copy.name = "stars";
    EXPECT_EQ(copy, scene.layers[1]);
    const Track* track = find_track(scene, "layer.stars_2.render.core");
    ASSERT_TRUE(track);
    EXPECT_EQ(track->keyframes, find_track(scene, "layer.stars.render.core")->keyframes);
}

TEST_F(Layers, Remove) {
    remove_layer(scene, 1);
    EXPECT_EQ(names(), Names{"dust"});
    EXPECT_FALSE(is_animated(scene, "layer.stars.render.core"));
    EXPECT_TRUE(is_animated(scene, "layer.dust.look.noise.1.jitter"));
}

TEST_F(Layers, Move) {
    duplicate_layer(scene, 0);
    move_layer(scene, 0, 2);
    EXPECT_EQ(names(), (Names{"dust_2", "stars", "dust"}));
    move_layer(scene, 2, 0);
    EXPECT_EQ(names(), (Names{"dust", "dust_2", "stars"}));
    move_layer(scene, 0, 99);
    EXPECT_EQ(names(), (Names{"dust_2", "stars", "dust"}));
}

TEST_F(Layers, Rename) {
    rename_layer(scene, 1, "suns");
    EXPECT_EQ(names(), (Names{"dust", "suns"}));
    EXPECT_TRUE(is_animated(scene, "layer.suns.render.core"));
    EXPECT_FALSE(is_animated(scene, "layer.stars.render.core"));
    const Scene before = scene;
    EXPECT_EQ(ERROR_OF(rename_layer(scene, 1, "dust")),
              "suns: layer.name: expected each name once, found 'dust' twice");
    EXPECT_EQ(ERROR_OF(rename_layer(scene, 1, "2")),
              "suns: layer.name: expected letters, digits and _ beginning with a letter, found '2'");
    rename_layer(scene, 1, "suns");
    EXPECT_EQ(scene, before);
}

TEST_F(Layers, ANameThatBeginsLikeAnotherKeepsItsTracks) {
    scene.layers[0].name = "star";
    rename_layer(scene, 0, "gas");
    EXPECT_TRUE(is_animated(scene, "layer.stars.render.core"));
}

TEST(LayersInAFile, EveryChangeIsSavedAndLoaded) {
    const test::SceneFolder f;
    f.folder.file("m 33 ü.png", "P2\n1 1\n255\n9\n");  // a PNM, whatever its name
    Document document = Document::open(f.file);
    const auto saves = [&] {
        document.save();
        ASSERT_EQ(load_scene(f.file), document.scene()) << f.text();
    };
    document.edit("Duplicate", [](Scene& s) { duplicate_layer(s, 0); });
    saves();
    document.edit("Move", [](Scene& s) { move_layer(s, 0, 2); });
    saves();
    document.edit("Add", [&](Scene& s) { EXPECT_EQ(add_layer(s, f.folder / "m 33 ü.png"), 3u); });
    EXPECT_EQ(document.scene().layers[3].name, "m_33");
    EXPECT_EQ(document.scene().layers[3].source.meshes[0].texture[0], f.folder / "m 33 ü.png");
    saves();
    document.edit("Remove", [](Scene& s) { remove_layer(s, 1); });
    saves();
    EXPECT_HAS(f.text(), "# by hand, keep this");
    for (int i = 0; i < 4; ++i) document.undo();
    document.save();
    EXPECT_EQ(load_scene(f.file), parse_scene(test::edit_scene, f.file));
}

TEST(Presets, GiveLookAndRender) {
    const TempFolder folder;
    const fs::path preset =
        folder.file("vorlage ä.toml", "[look]\nalpha = { power = 3.0 }\n[render]\nblend = \"add\"\n");
    Scene scene = parse_scene(test::edit_scene, folder / "scene.toml");
    LayerParams& layer = scene.layers[0];
    const SourceParams source = layer.source;
    apply_preset(layer, preset);
    EXPECT_EQ(layer.look.alpha.power, 3.0f);
    EXPECT_EQ(layer.render.blend, Blend::add);
    EXPECT_TRUE(layer.look.noise.empty());  // the whole look
    EXPECT_EQ(layer.name, "dust");
    EXPECT_EQ(layer.source, source);
    EXPECT_TRUE(layer.preset.empty());
    const LayerParams before = layer;
    folder.file("schlecht.toml", "[look]\ndensty = 1\n");
    EXPECT_EQ(ERROR_OF(apply_preset(layer, folder / "schlecht.toml")),
              (folder / "schlecht.toml").string() + ":2: unknown key 'densty'; did you mean 'look.density'?");
    EXPECT_EQ(layer, before);
}

// Every parameter of describe(), edited at random: what it is set to it is, undo and redo lead back and
// forth, and what is saved loads as the same scene. New parameters are tested as soon as they are described.

using test::Numbers;
using test::random_value;
using test::SceneFolder;
using test::value_of;

std::vector<ParameterSpec> specs_of(const Document& document) {
    Scene scene = document.scene();
    std::vector<ParameterSpec> specs;
    for (const Parameter& parameter : describe(scene).parameters) specs.push_back(parameter.spec);
    return specs;
}

/// False where a rule between parameters refused the value; the scene is then as before.
bool try_set(Document& document, const std::string& key, const Value& value, double frame) {
    const Scene before = document.scene();
    if (ERROR_OF(document.set(key, value, frame)) == "no error") return true;
    EXPECT_EQ(document.scene(), before) << key;
    return false;
}

/// Rules between parameters may refuse these: curves without points, half of a pair such as radius.min above
/// max, a cube that is none, a camera file that is not there, places that need a camera or a
/// file beside them, tiles of detail that are none.
bool may_be_refused(const std::string& key) {
    return std::ranges::any_of(
        std::initializer_list<const char*>{".shape", ".radius.min", ".radius.max", ".source.kind",
                                           ".source.uv", ".prepare.alpha", "camera.file", ".thickness.map",
                                           ".hybrid.from_deg", ".hybrid.to_deg", "environment.cube",
                                           ".detail_tiles"},
        [&](const char* ending) { return key.ends_with(ending); });
}

TEST(EveryParameter, GoesForthAndBackAndThroughTheFile) {
    const SceneFolder f;
    f.folder.file("vorlage.toml", "[look]\nnoise = { cull = 0.5 }\n[render]\ncore = 0.25\n");
    Document document = Document::open(f.file);
    const Scene start = document.scene();
    Numbers numbers(1);
    std::size_t refused = 0;
    const std::vector<ParameterSpec> specs = specs_of(document);
    for (const ParameterSpec& spec : specs) {
        const Value value = random_value(spec, numbers);
        if (!try_set(document, spec.key, value, 5.0)) {
            ++refused;
            EXPECT_TRUE(may_be_refused(spec.key)) << spec.key << " = " << to_toml(value);
            continue;
        }
        const Scene edited = document.scene();
        const fs::path copy = f.folder / "kopie.toml";
        Scene loaded = parse_scene(document.text_for(copy), copy);
        loaded.file = edited.file;
        EXPECT_EQ(loaded, edited) << spec.key << " = " << to_toml(value);
        if (!document.can_undo()) continue;  // the value it had
        document.undo();
        EXPECT_EQ(document.scene(), start) << spec.key;
        document.redo();
        EXPECT_EQ(document.scene(), edited) << spec.key;
        document.undo();
    }
    EXPECT_GT(specs.size(), 150u);
    EXPECT_LE(refused, specs.size() / 10) << "what is refused is not tried";
}

TEST(EveryParameter, ThousandsOfEditsUndoneRedoneAndSaved) {
    const SceneFolder f;
    f.folder.file("vorlage.toml", "[look]\nnoise = { cull = 0.5 }\n[render]\ncore = 0.25\n");
    Document document = Document::open(f.file);
    const Scene start = document.scene();
    Numbers numbers(2);
    std::vector<Scene> scenes{start};
    while (scenes.size() <= 400) {
        const std::vector<ParameterSpec> specs = specs_of(document);
        const ParameterSpec& spec = specs[numbers.below(specs.size())];
        if (!try_set(document, spec.key, random_value(spec, numbers), numbers.frame())) continue;
        if (document.scene() == scenes.back()) continue;
        scenes.push_back(document.scene());
        if (scenes.size() % 40 != 0) continue;
        document.save();
        ASSERT_EQ(load_scene(f.file), document.scene()) << f.text();
        ASSERT_FALSE(document.edited());
    }
    for (std::size_t i = scenes.size(); i-- > 0;) {
        ASSERT_EQ(document.scene(), scenes[i]) << i;
        document.undo();
    }
    EXPECT_FALSE(document.can_undo());
    for (const Scene& scene : scenes) {
        ASSERT_EQ(document.scene(), scene);
        document.redo();
    }
    for (int i = 0; i < 400; ++i) document.undo();
    document.save();
    EXPECT_EQ(load_scene(f.file), start);
    EXPECT_EQ(f.text().rfind("# by hand, keep this", 0), 0u);
}

// First scenes: what a dropped file becomes, and what the engine then makes of it.

const char* const tiny_picture = "P2\n1 1\n255\n9\n";  // a PNM, whatever its name
const char* const square = "v 0 0 0\nv 4 0 0\nv 4 0 2\nv 0 0 2\n";

struct NewFromFile : testing::Test {
    TempFolder folder;
    fs::path place = folder / "untitled.toml";
    Scene scene_for(const fs::path& file) const { return parse_scene(scene_text_for(file, place), place); }
};

TEST_F(NewFromFile, Kinds) {
    for (const char* name :
         {"a.png", "a b.JPG", "ä.fits", "a.fits.gz", "a.TIF", "a.exr", "a.FTS", "a.hdr", "A.FITS.GZ"})
        EXPECT_EQ(kind_of_file(name), FileKind::picture) << name;
    EXPECT_EQ(kind_of_file("a.OBJ"), FileKind::mesh);
    for (const char* name : {"a.pda", "a.ply", "a.splats"}) EXPECT_EQ(kind_of_file(name), FileKind::splats);
    for (const char* name : {"a.txt", "a.csv", "a", ".png", "a.gz", "a.mp4", "a.null"})
        EXPECT_EQ(kind_of_file(name), FileKind::unknown) << name;
    EXPECT_EQ(kind_of_file(folder.file("s ä.toml", test::edit_scene)), FileKind::scene);
    EXPECT_EQ(kind_of_file(folder.file("l.toml", "astrosplat = 1\nlayer = [ { name = \"a\" } ]\n")),
              FileKind::scene);
    EXPECT_EQ(kind_of_file(folder.file("r.toml", "layer = [ { name = \"a\" } ]\n[render]\nthreads = 1\n")),
              FileKind::scene);
    EXPECT_EQ(kind_of_file(folder.file("p.toml", "[look]\ndensity = 1\n")), FileKind::look);
    EXPECT_EQ(kind_of_file(folder.file("n.toml", "astrosplat = 1\n[output]\nfps = 24.0\n")), FileKind::scene);
    EXPECT_EQ(kind_of_file(folder.file("c.toml", "[package]\n")), FileKind::scene);  // whose loader says more
}

TEST_F(NewFromFile, APictureBecomesAPlane) {
    const fs::path picture = folder.file("m 51 ä.png", tiny_picture);
    const Scene scene = scene_for(picture);
    ASSERT_EQ(scene.layers.size(), 1u);
    EXPECT_EQ(scene.layers[0].name, "m_51");
    EXPECT_EQ(scene.layers[0].source.meshes[0].mesh, "plane");
    EXPECT_EQ(scene.layers[0].source.meshes[0].texture[0], picture);
}

TEST_F(NewFromFile, AMeshTakesItsOwnPictures) {
    folder.file("m.mtl", "newmtl a\nmap_Kd a ä.png\n");
    const fs::path mesh = folder.file(
        "mein netz.obj", std::string("mtllib m.mtl\n") + square +
                             "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
    const Scene scene = scene_for(mesh);
    EXPECT_EQ(scene.layers[0].name, "mein_netz");
    EXPECT_EQ(scene.layers[0].source.meshes[0].mesh, mesh);
    EXPECT_TRUE(scene.layers[0].source.meshes[0].texture.empty());
    EXPECT_EQ(scene.layers[0].source.uv, UvMode::mesh);
}

TEST_F(NewFromFile, AMeshWithoutPicturesTakesTheOneBesideIt) {
    const fs::path mesh = folder.file("netz.obj", std::string(square) + "f 1 2 3 4\n");
    EXPECT_TRUE(lacks_picture(scene_for(mesh).layers[0]));
    EXPECT_TRUE(scene_for(mesh).layers[0].source.meshes[0].texture.empty());
    const fs::path picture = folder.file("netz.png", "x");
    const Scene scene = scene_for(mesh);
    EXPECT_EQ(scene.layers[0].source.meshes[0].texture, std::vector<fs::path>{picture});
    EXPECT_EQ(scene.layers[0].source.uv, UvMode::planar_xz);  // thin in y, and without coordinates
}

TEST_F(NewFromFile, TheOnlyPictureOfAFolderWillDo) {
    const fs::path mesh = folder.file("netz.obj", std::string(square) + "f 1 2 3 4\n");
    const fs::path only = folder.file("bild ä.jpg", "x");
    EXPECT_EQ(scene_for(mesh).layers[0].source.meshes[0].texture, std::vector<fs::path>{only});
    folder.file("zweites.jpg", "x");
    EXPECT_TRUE(lacks_picture(scene_for(mesh).layers[0]));  // which one?
}

TEST_F(NewFromFile, ShapesAreScenesOfTheirOwn) {
    for (const std::string shape : shape_names) {
        const Scene scene = parse_scene(shape_scene_text(shape), place);
        ASSERT_EQ(scene.layers.size(), 1u);
        EXPECT_EQ(scene.layers[0].name, shape);
        EXPECT_EQ(scene.layers[0].source.meshes[0].mesh, shape);
        EXPECT_TRUE(is_builtin_mesh(shape));
        EXPECT_TRUE(lacks_picture(scene.layers[0]));
    }
    EXPECT_TRUE(parse_scene(empty_scene_text(), place).layers.empty());
}

TEST_F(NewFromFile, RealFiles) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(spot, "meshes/spot/spot_triangulated.obj");
    ASTROSPLAT_TEST_DATA_OR_SKIP(particles, "particles/circle.00001.pda");
    const std::vector<TexturedMesh> meshes = load_meshes(scene_for(spot).layers[0].source);
    ASSERT_EQ(meshes.size(), 1u);
    EXPECT_GT(meshes[0].mesh.triangles.size(), 1000u);
    EXPECT_GT(meshes[0].textures[0].image.width, 0);
    const LayerParams layer = scene_for(particles).layers[0];
    EXPECT_EQ(read_splats(layer.source.file).size(), 30);
    EXPECT_NEAR(layer.look.radius.min, 0.5 * std::sqrt(4.0 / 30.0), 0.01);  // a flat circle of radius 1
}

TEST_F(NewFromFile, TheProjectionIsAlongTheThinSide) {
    const fs::path picture = folder.file("a.png", "x");
    folder.file("a.obj", "v 0 0 0\nv 4 0 0\nv 4 2 0.5\nf 1 2 3\n");
    EXPECT_EQ(scene_for(folder / "a.obj").layers[0].source.uv, UvMode::planar_xy);
    folder.file("a.obj", "v 0 0 0\nv 0.5 2 0\nv 0 2 3\nf 1 2 3\n");
    EXPECT_EQ(scene_for(folder / "a.obj").layers[0].source.uv, UvMode::planar_yz);
}

TEST_F(NewFromFile, SplatsWithRadiiPassUnchanged) {
    const fs::path file =
        folder.file("r.ply",
                    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
                    "y\nproperty float z\nproperty float radius\nend_header\n0 0 0 0.5\n");
    const Scene scene = scene_for(file);
    EXPECT_EQ(scene.layers[0].source.kind, SourceKind::splats);
    EXPECT_EQ(scene.layers[0].source.file, file);
    EXPECT_EQ(scene.layers[0].look, Look{});
}

/// 1000 points over a cube of side 10: half their mean spacing is 0.5.
TEST_F(NewFromFile, SplatsWithoutRadiiGetSome) {
    std::string rows =
        "ply\nformat ascii 1.0\nelement vertex 1000\nproperty float x\nproperty float y\n"
        "property float z\nend_header\n";
    for (int i = 0; i < 1000; ++i)
        rows += std::to_string(i % 10 * 10 / 9.0) + " " + std::to_string(i / 10 % 10 * 10 / 9.0) + " " +
                std::to_string(i / 100 * 10 / 9.0) + "\n";
    const Scene scene = scene_for(folder.file("punkte ä.ply", rows));
    EXPECT_EQ(scene.layers[0].name, "punkte");
    EXPECT_EQ(scene.layers[0].look.radius.min, 0.5f);
    EXPECT_EQ(scene.layers[0].look.radius.max, 0.5f);
    EXPECT_NO_THROW(check_consistent(read_splats(scene.layers[0].source.file)));
}

TEST_F(NewFromFile, CapturesAreMixedInDisplayValuesAndFramedWithoutStrays) {
    std::vector<test::Trained> all = test::capture(400, 1);
    for (std::size_t i = 0; i < 10; ++i) all[i].position *= 1000.0;
    for (const std::string ending : {"ply", "glb"}) {
        const fs::path file =
            folder.file("capture." + ending, ending == "ply" ? test::ply_of(all, 1) : test::glb_of(all, 1));
        EXPECT_EQ(kind_of_file(file), FileKind::splats);
        const Scene scene = scene_for(file);
        const LayerParams& layer = scene.layers[0];
        EXPECT_EQ(layer.source.file, file);
        EXPECT_TRUE(is_mixed_in_display_space(layer.render));
        ASSERT_TRUE(scene.camera.position.has_value());
        for (int k = 0; k < 3; ++k) EXPECT_LT(std::fabs(scene.camera.target[k]), 1.0);
        EXPECT_NEAR(glm::distance(*scene.camera.position, scene.camera.target),
                    0.5 * 5.4 * std::sqrt(3.0) / std::sin(0.349), 2.0);
    }
    const fs::path linear = folder.file("linear.glb", test::glb_of(all, 0, "", "lin_rec709_display"));
    EXPECT_TRUE(scene_for(linear).layers[0].render.isolate);
    EXPECT_EQ(scene_for(linear).layers[0].render.space, BlendSpace::linear);
    EXPECT_EQ(kind_of_file(folder.file("camera.gltf", "{\"asset\":{\"version\":\"2.0\"}}")),
              FileKind::unknown);
    EXPECT_EQ(kind_of_file("missing.glb"), FileKind::splats);
}

TEST_F(NewFromFile, CataloguesOfTheSkyAreSeenFromTheOrigin) {
    const Scene scene = scene_for(folder.file("near stars.csv", "ra,dec,mag\n1,2,3\n"));
    ASSERT_EQ(scene.layers.size(), 1u);
    EXPECT_EQ(scene.layers[0].name, "near_stars");
    EXPECT_EQ(scene.layers[0].source.kind, SourceKind::stars);
    EXPECT_EQ(scene.layers[0].source.stars.catalogue, folder / "near stars.csv");
    EXPECT_EQ(scene.camera.position, glm::dvec3(0.0));
}

TEST_F(NewFromFile, StarsOfAPictureNeedItBesideThem) {
    const fs::path table = folder.file("stars.csv", "u,v,flux_r,flux_g,flux_b\n0.5,0.5,1,1,1\n");
    EXPECT_EQ(ERROR_OF(scene_text_for(table, place)),
              table.string() + ": expected picture.exr beside the stars of a picture, found none");
    folder.file("picture.exr", tiny_picture);  // what it is, its first bytes say
    EXPECT_EQ(scene_for(table).layers.at(1).source.stars.catalogue, table) << "the file that was opened";
}

TEST_F(NewFromFile, OtherFilesAreRefused) {
    const fs::path text = folder.file("a.txt", "x");
    EXPECT_EQ(
        ERROR_OF(scene_text_for(text, place)),
        text.string() +
            ": expected a picture (OpenEXR, TIFF, PNG, JPEG, FITS, XISF, Radiance HDR, DPX, WebP, JPEG 2000, "
            "Photoshop, BMP, GIF, TGA, PNM, HEIF or camera raw), a mesh (OBJ), splats (PDA, PLY, glTF, USD, "
            "SPZ, SPLAT, SOG or SPLATS) or a star catalogue, found another kind of file");
    EXPECT_EQ(ERROR_OF(scene_text_for(folder / "gone.png", place)),
              (folder / "gone.png").string() + ": cannot be read: No such file or directory");
    EXPECT_EQ(ERROR_OF(scene_text_for(folder.path(), place)),
              folder.path().string() + ": cannot be read: it is a folder");
}

TEST_F(NewFromFile, AFileFromElsewhereIsNamedInFull) {
    const TempFolder other;
    const fs::path picture = other.file("b.png", tiny_picture),
                   mesh = other.file("b.obj", std::string(square) + "f 1 2 3\n");
    EXPECT_EQ(scene_for(picture).layers[0].source.meshes[0].texture[0], picture);
    EXPECT_EQ(scene_for(mesh).layers[0].source.meshes[0].mesh, mesh);
}

TEST_F(NewFromFile, AddLayerKeepsNamesApart) {
    Scene scene = parse_scene(test::edit_scene, place);
    EXPECT_EQ(add_layer(scene, folder.file("dust.png", tiny_picture)), 2u);
    EXPECT_EQ(scene.layers[2].name, "dust_2");
    EXPECT_EQ(scene.layers[2].source.meshes[0].texture[0], folder / "dust.png");
    const Scene before = scene;
    EXPECT_THROW(add_layer(scene, folder.file("a.txt", "x")), InputError);
    EXPECT_EQ(scene, before);
}

}  // namespace
}  // namespace astrosplat
