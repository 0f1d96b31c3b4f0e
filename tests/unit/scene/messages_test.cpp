// One test for each message that a scene, a preset or --set can cause.

#include "core/atomic_file.h"
#include "scene/check.h"
#include "scene_texts.h"

namespace astrosplat::test {
namespace {

const std::string head =
    "astrosplat = 1\n[[layer]]\nname = \"stars\"\nsource.meshes = { mesh = \"disk\" }\n";  // 4 lines

struct Case {
    std::string lines;    // follow `head`, so the first is line 5
    std::string message;  // after "scene.toml:"
    friend void PrintTo(const Case& given, std::ostream* out) { *out << testing::PrintToString(given.lines); }
};

/// One wrong line of a section, and what is said of its key.
Case in(const std::string& section, const std::string& line, const std::string& said) {
    return {"[" + section + "]\n" + line + "\n", "6: " + section + "." + said};
}
Case look(const std::string& line, const std::string& said, const std::string& of = "layer.look.") {
    return {"[layer.look]\n" + line + "\n", "6: " + of + said};
}
/// Of the first layer's source.
Case source(const std::string& line, const std::string& said) {
    return {"source." + line + "\n", "5: layer.source." + said};
}
/// Of a layer's source that is a disk.
Case disk(const std::string& line, const std::string& said) {
    return {"meshes = { mesh = \"disk\" }\n" + line + "\n", "6: layer." + said};
}

class WrongKeys : public testing::TestWithParam<Case> {};

TEST_P(WrongKeys, SayWhatIsExpected) {
    EXPECT_EQ(message(head + GetParam().lines), "scene.toml:" + GetParam().message);
}

class WrongSources : public testing::TestWithParam<Case> {};

TEST_P(WrongSources, SayWhatIsExpected) {
    const std::string source = "astrosplat = 1\n[[layer]]\nname = \"stars\"\n[layer.source]\n";  // 4 lines
    EXPECT_EQ(message(source + GetParam().lines), "scene.toml:" + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Keys, WrongSources,
    testing::Values(
        disk("mask = { luminance = [0.5, 0.5] }",
             "stars.source.mask.0.luminance: expected the lower end first, found 0.5 and 0.5"),
        disk("mask = [{ hue = [10, 20] }, { saturation = [0.5, 0.1] }]",
             "stars.source.mask.1.saturation: expected the lower end first, found 0.5 and 0.1"),
        disk("mask = { any = [{}, { ellipse = [0.5, 0.5, 0, 1] }] }",
             "stars.source.mask.0.any.1.ellipse: expected half axes above 0, found 0 and 1"),
        disk("mask = { hue = [0, 400] }", "source.mask.hue: expected 2 numbers from 0 to 360, found 400"),
        Case{"meshes = { mesh = \"disk\" }\nmask = { any = { lumnance = [0, 1] } }\n",
             "6: unknown key 'mask.any.lumnance'; did you mean 'layer.source.mask.any.luminance'?"},
        disk("mask = \"spot.png\"", "source.mask: expected a table or a list of tables, found a string"),
        Case{"meshes = { mesh = \"disk\" }\ncount = 100000\nsplats = 1000\n",
             "7: layer.stars.source.splats: expected count or splats, found both"},
        Case{"meshes = { mesh = \"disk\" }\nvoxel_size = 0.1\nsplats = 1000\n",
             "7: layer.stars.source.splats: expected voxels, voxel_size or splats, found two of them"},
        Case{"seed = 1\nmeshes = { mesh = \"revolution\" }\n",
             "6: layer.stars.source.meshes.0.mesh: expected at least 2 points for mesh \"revolution\", found "
             "none"},
        Case{"seed = 1\nmeshes = { mesh = \"revolution\", outline = [[1, 0], [-1, 2]] }\n",
             "6: layer.stars.source.meshes.0.outline: expected points [r, y] with r of at least 0, found one "
             "below"},
        Case{"seed = 1\nmeshes = { mesh = \"ring\", tube = 0.7 }\n",
             "6: layer.source.meshes.tube: expected a number from 0.001 to 0.5, found 0.7"},
        disk("back = \"front\"", "source.back: expected same, mirrored or varied, found 'front'"),
        disk("uv_width = -1", "source.uv_width: expected a number of at least 0, found -1"),
        disk("uv = \"camera\"",
             "stars.source.uv: expected the place of the camera for uv \"camera\", found none"),
        Case{"uv = \"camera\"\nmeshes = { mesh = \"disk\" }\nuv_camera = { fov = 30 }\n",
             "5: layer.stars.source.uv: expected the place of the camera for uv \"camera\", found none"},
        Case{"meshes = { mesh = \"disk\" }\nuv = \"camera\"\nuv_camera = { position = [0, 1, 0], target = "
             "[0, 1, 0] }\n",
             "7: layer.stars.source.uv_camera.position: expected target and position apart, found the same "
             "point"},
        Case{"meshes = { mesh = \"disk\" }\nuv = \"camera\"\nuv_camera = { position = [0, 1, 0], up = [0, 0, "
             "0] }\n",
             "7: layer.stars.source.uv_camera.up: expected a direction, found 0, 0, 0"},
        disk("uv_camera = { fov = 180 }",
             "source.uv_camera.fov: expected a number of at least 0.001 and below 180, found 180"),
        disk("uv_camera = { height = -1 }",
             "source.uv_camera.height: expected a number of at least 0, found -1"),
        Case{"meshes = { mesh = \"disk\" }\nuv_camera = { fow = 40 }\n",
             "6: unknown key 'uv_camera.fow'; did you mean 'layer.source.uv_camera.fov'?"},
        disk("structure = { flare = -1 }",
             "source.structure.flare: expected a number from -0.9 to 10, found -1"),
        disk("structure = { warp = 2 }", "source.structure.warp: expected a number from -1 to 1, found 2"),
        Case{"kind = \"stars\"\ncatalogue = \"a.csv\"\nlike = \"gas\"\n",
             "7: layer.stars.source.like: expected the name of a layer with a picture, found 'gas'"},
        Case{"kind = \"stars\"\nlike = \"stars\"\n",
             "6: layer.stars.source.like: expected a catalogue, the stars.csv of the picture, found none"},
        Case{"kind = \"stars\"\ncatalogue = \"a.csv\"\nlike = \"gas\"\nalong = \"camera\"\n",
             "8: layer.stars.source.along: expected like or along, found both"},
        Case{"kind = \"stars\"\ncatalogue = \"a.csv\"\nlike = \"gas\"\ndepth = \"layers\"\n",
             "8: layer.source.depth: expected layer or magnitude, found 'layers'; did you mean 'layer'?"},
        disk("derive = \"dst\"",
             "source.derive: expected none, dust, h_alpha or young_stars, found 'dst'; did you mean 'dust'?"),
        disk("prepare = { ellipse = [9, 9, 4, 0] }",
             "stars.source.prepare.ellipse: expected half axes above 0, found 4 and 0"),
        disk("prepare = { alpha = [0.5, 0.1] }",
             "stars.source.prepare.alpha: expected the lower end first, found 0.5 and 0.1"),
        disk("prepare.stars = \"removed\"",
             "source.prepare.stars: expected keep or remove, found 'removed'; did you mean 'remove'?"),
        disk("prepare.background = true",
             "source.prepare.background: expected keep, level, plane or curved, found 'true'"),
        disk("prepare = { threshold = 0 }",
             "source.prepare.threshold: expected a number from 0.01 to 1000000000, found 0"),
        disk("prepare = { saturation = -1 }",
             "source.prepare.saturation: expected a number from 1e-09 to 1000000000 or \"auto\", found -1"),
        disk("prepare = { lupton = 1 }", "source.prepare.lupton: expected true or false, found a number"),
        disk("prepare = { q = 0 }", "source.prepare.q: expected a number from 1e-06 to 1000000, found 0"),
        disk("prepare = { lupton_stretch = 0 }",
             "source.prepare.lupton_stretch: expected a number from 1e-09 to 1000000000, found 0"),
        disk("prepare = { turn = \"left\" }", "source.prepare.turn: expected a number, found a string"),
        disk("prepare = { feather = 2 }", "source.prepare.feather: expected a number from 0 to 1, found 2"),
        disk("prepare = { align = 3 }", "source.prepare.align: expected a file name, found a number"),
        disk("prepare = { fill = 3 }", "source.prepare.fill: expected a file name, found a number"),
        disk("prepare = { mask = [] }", "source.prepare.mask: expected a file name, found a list of 0"),
        Case{"meshes = { mesh = \"disk\" }\nprepare = { star = \"keep\" }\n",
             "6: unknown key 'prepare.star'; did you mean 'layer.source.prepare.stars'?"},
        disk("smooth = 0.5", "source.smooth: expected a number from 0 to 0.2, found 0.5")));

INSTANTIATE_TEST_SUITE_P(
    Keys, WrongKeys,
    testing::Values(
        Case{"[layer.look]\nalpha.powr = 2\n",
             "6: unknown key 'alpha.powr'; did you mean 'layer.look.alpha.power'?"},
        Case{"[layer.look]\nalpha = { powr = 2 }\n",
             "6: unknown key 'alpha.powr'; did you mean 'layer.look.alpha.power'?"},
        Case{"[layer.look]\nnoise = [{ cul = 0.5 }]\n",
             "6: unknown key 'noise.cul'; did you mean 'layer.look.noise.cull'?"},
        Case{"[layer.look]\nopacity = 0.5\n",
             "6: unknown key 'opacity'; did you mean 'layer.render.opacity'?"},
        Case{"[outptu]\nfps = 24\n", "6: unknown key 'outptu.fps'; did you mean 'output.fps'?"},
        Case{"[nonsense]\n", "5: unknown key 'nonsense'; 'astrosplat parameters' lists all keys"},
        Case{"[layer.look]\n\"alpha.power\" = 2\n",
             "6: unknown key '\"alpha.power\"'; did you mean 'layer.look.alpha.power'?"},
        look("alpha.power = \"6\"", "alpha.power: expected a number, found a string"),
        look("density = [1, {}]", "density: expected a value, found a table"),
        look("noise = [1, {}]", "noise: expected a table or a list of tables, found a list of 2"),
        look("alpha = 6",
             "alpha: expected a table, found a number; it has keys such as layer.look.alpha.power"),
        look("density = { x = 6 }", "density: expected a number from 0 to 1000000, found a table"),
        look("density = 2020-01-01", "density: expected a value, found a date"),
        look("density = nan", "density: expected a finite number, found nan"),
        look("density = -inf", "density: expected a finite number, found inf"),
        look("density = 1e39", "density: expected a number from 0 to 1000000, found 1e+39"),
        look("density = -1", "density: expected a number from 0 to 1000000, found -1"),
        look("crop = [{ shape = \"cone\" }]", "crop.shape: expected box, sphere or outline, found 'cone'"),
        Case{
            "[layer.look]\ncrop = [{}, { shape = \"outline\" }]\n",
            "6: layer.stars.look.crop.1.shape: expected lines \"M x y x y ... M ...\" of at least two points "
            "each, found nothing"},
        Case{"[layer.look]\ncrop = [{ shape = \"outline\", outline = \"M 1 2 3 4 L 5 6\" }]\n",
             "6: layer.stars.look.crop.0.outline: expected lines \"M x y x y ... M ...\" of at least two "
             "points "
             "each, found 'L 5 6'"},
        look("crop = [{}, { radius = 0 }]", "crop.radius: expected a number of at least 1e-06, found 0"),
        Case{"[layer.look]\ncrop = [{ box = [0, 0, 0] }]\n",
             "6: unknown key 'crop.box'; 'astrosplat parameters' lists all keys"},
        look("noise = 3", "noise: expected a table or a list of tables, found a number"),
        look("noise.octaves = 2.5", "noise.octaves: expected a whole number, found 2.5"),
        look("noise.octaves = 17", "noise.octaves: expected a whole number from 1 to 16, found 17"),
        look("grade.tint = [1, 1]", "grade.tint: expected 3 numbers from 0 to 1000000, found a list of 2"),
        look("grade.tint = [1, 1, true]",
             "grade.tint: expected 3 numbers from 0 to 1000000, found true among them"),
        look("alpha.unpremultiply = 1", "alpha.unpremultiply: expected true or false, found a number"),
        look("pdf.points = [[0, 1]]", "pdf.points: expected at least 2 points, found 1"),
        look("pdf.points = [[0, 1], [0, 0.5]]",
             "pdf.points: expected points with ascending x, found 0 after 0"),
        look("pdf.points = [0, 1]", "pdf.points: expected a list of points [[x, y], ...], found a number"),
        look("pdf.shape = \"curve\"", "pdf.shape: expected at least 2 points for shape \"curve\", found none",
             "layer.stars.look."),
        look("vertical.shape = \"curve\"",
             "vertical.shape: expected at least 2 points for shape \"curve\", found none",
             "layer.stars.look."),
        look("thickness.map = \"a.png\"",
             "thickness.map: expected thickness.keys that the map's colours stand for, found none",
             "layer.stars.look."),
        look("thickness.keys = [{}, {}]",
             "thickness.keys: expected a thickness.map for several stops, found none", "layer.stars.look."),
        Case{"[layer.look]\nradius.min = 0.2\nradius.max = 0.1\n",
             "7: layer.stars.look.radius.max: expected min not above max, found 0.2 and 0.1"},
        in("layer.render", "blend = \"ovr\"",
           "blend: expected over, add, screen, lighten, hybrid or absorb, found 'ovr'; did you mean 'over'?"),
        in("layer.render", "blend = [1]",
           "blend: expected over, add, screen, lighten, hybrid or absorb, found a list of 1"),
        Case{"[layer.render]\nhybrid = { from_deg = 60, to_deg = 40 }\n",
             "6: layer.stars.render.hybrid.to_deg: expected from_deg below to_deg, found 60 and 40"},
        Case{"[layer.source]\n", "5: duplicate key 'layer.source'"},
        Case{"source.voxels = [4, 4, 4]\nsource.voxel_size = 0.5\n",
             "6: layer.stars.source.voxel_size: expected voxels or voxel_size, found both"},
        source("voxels = [4, 4, 0.5]", "voxels: expected 3 numbers from 1 to 1000000 or \"auto\", found 0.5"),
        source("voxels = \"many\"",
               "voxels: expected 3 numbers from 1 to 1000000 or \"auto\", found a string"),
        Case{"source.black = 3\nsource.white = 2\n",
             "6: layer.stars.source.white: expected black below white, found 3 and 2"},
        Case{"source.kind = \"splats\"\n",
             "5: layer.stars.source.kind: expected a splat file for kind \"splats\", found none"},
        Case{"source.kind = \"stars\"\n",
             "5: layer.stars.source.kind: expected a star catalogue, or along = \"camera\", for kind "
             "\"stars\", found none"},
        source("along = \"orbit\"", "along: expected  or camera, found 'orbit'"),
        source("spread = 0", "spread: expected a number from 1e-09 to 1000000000, found 0"),
        Case{"source.kind = \"stars\"\nsource.catalogue = \"a.csv\"\nsource.wings = { share = 0.5 "
             "}\nsource.spikes = { share = 0.75 }\n",
             "8: layer.stars.source.spikes.share: expected shares of wings and spikes of at most 1 together, "
             "found 0.5 and 0.75"},
        source("wings = { share = 1.5 }", "wings.share: expected a number from 0 to 1, found 1.5"),
        source("wings = { power = 1 }", "wings.power: expected a number from 1.01 to 20, found 1"),
        source("wings = { px = 0 }", "wings.px: expected a number from 0.01 to 1000, found 0"),
        Case{"source.wings = { shar = 0.5 }\n",
             "5: unknown key 'wings.shar'; did you mean 'layer.source.wings.share'?"},
        source("spikes = { vanes = 0 }", "spikes.vanes: expected a whole number from 1 to 16, found 0"),
        source("spikes = { px = \"long\" }", "spikes.px: expected a number, found a string"),
        source("spikes = { angle = [1] }", "spikes.angle: expected a number, found a list of 1"),
        source("psf = 0", "psf: expected a number from 0.01 to 100, found 0"),
        source("zero_point = 1000", "zero_point: expected a number from -100 to 100, found 1000"),
        Case{"axis = [0, 0, 0]\n", "5: layer.stars.axis: expected a direction, found 0, 0, 0"},
        Case{"[[layer]]\nsource.kind = \"stars\"\n", "5: layer: expected a name, found none"},
        Case{"[[layer]]\nname = 3\n", "6: layer.name: expected a string, found a number"},
        Case{"[[layer]]\nname = \"stars\"\n", "6: layer.name: expected each name once, found 'stars' twice"},
        Case{"[[layer]]\nname = \"2nd\"\n",
             "6: layer.name: expected letters, digits and _ beginning with a letter, found '2nd'"},
        Case{"[[layer]]\nname = \"b\"\n", "5: layer.b.source.meshes: expected at least one mesh, found none"},
        Case{"[[layer]]\nname = \"b\"\nsource.meshes = [{ texture = \"a.png\" }]\n",
             "7: layer.b.source.meshes.0.mesh: expected a file or plane, relief, sheet, disk, sphere, "
             "spheroid, shell, bubble, hourglass, ring, revolution, found none"},
        Case{"[[layer]]\nname = \"b\"\nsource.meshes = [{ mesh = \"disk\", texture = [\"a\", \"b\"] }]\n",
             "7: layer.b.source.meshes.0.texture: expected one picture, or three for red, green and blue, "
             "found 2"},
        Case{"[output]\nfps = 1\nfps = 2\n", "7: duplicate key 'fps'"},
        Case{"[output]\nfps = \n", "6: not valid TOML: key-value pair: expected value, saw '\\n'"},
        in("output", "frames = \"1-x\"", "frames: expected frames such as 1-100,120,200-300x2, found '1-x'"),
        in("output", "path = \"\"", "path: expected a file name, found an empty one"),
        in("output", "path = \"${ASTROSPLAT_NOT_THERE}/a.####.exr\"",
           "path: expected the environment variable ASTROSPLAT_NOT_THERE to be set, found it undefined"),
        in("output", "path = \"${HOME/a.####.exr\"", "path: expected '}' after '${', found none"),
        in("output", "aovs = [\"depht\"]",
           "aovs: expected a list of depth, coverage, count or layers, found 'depht'; did you mean 'depth'?"),
        in("output", "aovs = [\"depth\", \"depth\"]",
           "aovs: expected a list of depth, coverage, count or layers, found 'depth' twice"),
        Case{"[[reference]]\nframes = \"1-x\"\n",
             "6: reference.frames: expected frames such as 1-100,120,200-300x2, found '1-x'"},
        Case{"[[reference]]\nscale = 0\n",
             "6: reference.scale: expected a number from 1e-06 to 1000000, found 0"},
        Case{"[[reference]]\nviw = \"top\"\n", "6: unknown key 'viw'; did you mean 'reference.view'?"},
        Case{"[provenance]\ntype = \"Photo\"\n",
             "6: provenance.type: expected auto, Artwork or Simulation, found 'Photo'"},
        in("camera", "up = [0, 0, 0]", "up: expected a direction, found 0, 0, 0"),
        in("camera", "rotation = [0, 0, 0, 0]",
           "rotation: expected a quaternion that is not zero, found 0, 0, 0, 0"),
        in("camera", "fov = 180", "fov: expected a number of at least 0.001 and below 180, found 180"),
        in("camera", "fov = 1e-30", "fov: expected a number of at least 0.001 and below 180, found 1e-30"),
        in("camera", "focal_length = 1e30", "focal_length: expected a number from 0 to 1000000, found 1e+30"),
        in("camera", "position = [1e300, 0, 0]",
           "position: expected 3 numbers within 1e+12 of 0, found 1e+300"),
        Case{"transform.scale = 1e30\n",
             "5: layer.transform.scale: expected a number from 1e-09 to 1000000000, found 1e+30"},
        Case{"[camera]\nnear = 5\nfar = 2\n", "7: camera.far: expected far beyond near or 0, found 5 and 2"},
        in("environment", "cube = [\"a\", \"b\"]",
           "cube: expected six pictures of the faces of a cube, in the order +x -x +y -y +z -z, found 2"),
        Case{"[environment]\nimage = \"a\"\ntile = \"b\"\n",
             "7: environment.tile: expected image, cube or tile, found several of them"},
        Case{"[environment]\ntile = \"b\"\ntile_height = 1\n",
             "7: environment.tile_height: expected a number from 2 to 120, found 1"},
        Case{"[environment]\nimage = \"a\"\ncube = [\"a\", \"b\", \"c\", \"d\", \"e\", \"f\"]\n",
             "7: environment.cube: expected image or cube, found both"},
        in("environment", "cube = [\"a\", \"\"]",
           "cube: expected a file name or a list of them, found an empty file name")));

/// A wrong track, and what is said of its key.
Case track(const std::string& key, const std::string& value, const std::string& said) {
    return {"\"" + key + "\" = " + value + "\n", key + ": " + said};
}

Case fov(const std::string& keyframes, const std::string& said) {
    return track("camera.fov", "{ keys = [" + keyframes + "] }", said);
}

class WrongTracks : public testing::TestWithParam<Case> {};

TEST_P(WrongTracks, SayWhatIsExpected) {
    EXPECT_EQ(message(head + "[animation]\n" + GetParam().lines), "scene.toml:6: " + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Tracks, WrongTracks,
    testing::Values(
        Case{"\"camera.fow\" = { keys = [[1, 20]] }\n",
             "unknown key 'camera.fow'; did you mean 'camera.fov'?"},
        track("layer.star.look.reach", "{ keys = [[1, 20]] }", "unknown layer 'star'; did you mean 'stars'?"),
        Case{"\"layer.stars.look.rech\" = { keys = [[1, 20]] }\n",
             "unknown key 'layer.stars.look.rech'; did you mean 'layer.stars.look.reach'?"},
        track("layer.stars.source.jitter", "{ keys = [[1, 0]] }", "this parameter cannot be animated"),
        track("layer.stars.look.noise.2.cull", "{ keys = [[1, 0]] }",
              "expected an index of at most 0 in layer.look.noise, found 2"),
        Case{"camera.fov = { keys = [[1, 20]] }\n",
             "camera: expected the whole key in quotes, such as \"camera.position\", found a table"},
        track("camera.fov", "3", "expected { keys = [[frame, value], ...] }, found no keyframes"),
        fov("", "expected { keys = [[frame, value], ...] }, found no keyframes"),
        fov("[1]", "expected keyframes [frame, value] or [frame, value, \"smooth\"], found a list of 1"),
        fov("[\"a\", 3]", "expected a frame number first in a keyframe, found a string"),
        fov("[nan, 3]", "expected a frame number first in a keyframe, found a number"),
        fov("[1, 200]", "frame 1: expected a number of at least 0.001 and below 180, found 200"),
        fov("[1, nan]", "frame 1: expected a finite number, found nan"),
        track("camera.position", "{ keys = [[1, []]] }", "frame 1: expected 3 numbers, found none"),
        track("camera.rotation", "{ keys = [[1, [0, 0, 0, 0]]] }",
              "frame 1: expected a quaternion that is not zero, found 0, 0, 0, 0"),
        fov("[2, 30], [2, 30]", "expected each frame once, found 2 twice"),
        fov("[2, 30], [1, 30]", "expected ascending frames, found 1 after 2"),
        fov("[2, 30, \"smoth\"]",
            "the way to the next keyframe: expected linear, smooth, step, bezier, found 'smoth'; did you "
            "mean 'smooth'?"),
        fov("[2, 30, \"bezier\", \"round\"]",
            "expected handles \"flat\" or { in = [frames, value], out = ... }, found 'round'"),
        fov("[2, 30, \"bezier\", { out = 3 }]",
            "out: expected auto, flat or [frames, value], found a number"),
        fov("[2, 30, \"bezier\", { out = \"linear\" }]",
            "out: expected auto, flat or [frames, value], found 'linear'"),
        fov("[2, 30, \"bezier\", { in = [-3] }]",
            "in: expected [frames, value] from the keyframe, found a list of 1"),
        fov("[2, 30, \"bezier\", { in = [3, 1] }]", "in: expected 0 or negative frames, found 3"),
        fov("[2, 30, \"bezier\", { out = [-3, 1] }]", "out: expected 0 or more frames, found -3"),
        fov("[2, 30, \"bezier\", { out = [3, inf] }]",
            "out: expected a finite number in a handle, found a number"),
        track("camera.position", "{ keys = [[2, [1, 2, 3], \"bezier\", { out = [3, 1] }]] }",
              "out: expected as many numbers as the keyframe's value has, 3, found 1"),
        fov("[2, 30, \"bezier\", { broken = 1 }]", "broken: expected true or false, found a number"),
        fov("[2, 30, \"bezier\", { inn = \"flat\" }]", "unknown key 'inn' of a keyframe; did you mean 'in'?"),
        track("camera.rotation", "{ keys = [[2, [0, 0, 0, 1]]], interpolation = \"bezier\" }",
              "expected linear, smooth or step for a rotation, found bezier"),
        track("camera.fov", "{ keys = [[2, 30]], ends = \"loop\" }",
              "ends: expected ease, through, found 'loop'"),
        track("camera.fov", "{ keys = [[2, 30]], end = \"ease\" }",
              "unknown key 'end'; did you mean 'ends'?"),
        track("camera.fov", "{ keys = [[2, 30]], constant_speed = true }",
              "constant_speed: expected it on a position, found it on another parameter"),
        track("camera.position", "{ keys = [[2, [1, 2, 3]]], constant_speed = 1 }",
              "constant_speed: expected true or false, found a number"),
        track("layer.stars.look.pdf.points",
              "{ keys = [[1, [[0, 1], [1, 0]]], [2, [[0, 1], [0.5, 1], [1, 0]]]] }",
              "expected as many points in every keyframe, found another number")));

TEST(Messages, WholeFiles) {
    EXPECT_EQ(message(""),
              "scene.toml: expected a scene that begins with 'astrosplat = 1', found an empty file");
    EXPECT_EQ(message("[output]\n"),
              "scene.toml: expected a scene that begins with 'astrosplat = 1', found no such line");
    const TempFolder folder;
    const fs::path splats = folder.file("a.ply", "ply\nformat ascii 1.0\n");
    EXPECT_EQ(ERROR_OF(load_scene(splats)), splats.string() + ": expected a scene, found PLY");
    EXPECT_EQ(message("\nastrosplat = 2\n"),
              "scene.toml:2: astrosplat: expected the format version 1, found 2");
    EXPECT_EQ(message("astrosplat = \"1\"\n"),
              "scene.toml:1: astrosplat: expected the format version 1, found a string");
    EXPECT_EQ(ERROR_OF(check_renderable(parse_scene("astrosplat = 1\n", "scene.toml"), {})),
              "scene.toml: expected at least one [[layer]], found none");
    EXPECT_EQ(message("astrosplat = 1\n[layer]\nname = \"a\"\n"),
              "scene.toml:2: layer: expected [[layer]], found a table");
    EXPECT_EQ(message("astrosplat = 1\nanimation = 2\n"),
              "scene.toml:2: animation: expected a table, found a number");
    EXPECT_EQ(message("astrosplat = 1\n[output]\nfps = [24,\n"),
              "scene.toml:3: not valid TOML: array: encountered end-of-file");
    EXPECT_EQ(message("astrosplat = 1\ntitle = \"\xff\"\n"),
              "scene.toml:2: not valid TOML: encountered invalid utf-8 sequence");
}

TEST(Messages, FilesThatCannotBeRead) {
    const std::string folder = fs::temp_directory_path().string();
    EXPECT_EQ(ERROR_OF(load_scene(folder)), folder + ": cannot be read: it is a folder");
    EXPECT_EQ(ERROR_OF(load_scene("no such.toml")),
              "no such.toml: cannot be read: No such file or directory");
}

TEST(Messages, DomesAreSquareAndOfAPlanetariumsSize) {
    const auto sized = [](const std::string& size) {
        return message(head + "[output]\npreset = \"dome\"\nresolution = [" + size + "]\n");
    };
    const std::string expected =
        "scene.toml:7: output.resolution: expected a square of 1024 to 8192 px for the preset dome, found ";
    EXPECT_EQ(sized("4096, 2160"), expected + "4096 x 2160");
    EXPECT_EQ(sized("1023, 1023"), expected + "1023 x 1023");
    EXPECT_EQ(sized("8193, 8193"), expected + "8193 x 8193");
    for (const char* size : {"1024, 1024", "8192, 8192"}) EXPECT_EQ(sized(size), "") << size;
    const fs::path own = fs::temp_directory_path() / "dome.toml";
    write_file_atomically(own, "[output]\nresolution = [500, 500]\n");
    EXPECT_EQ(message(head + "[output]\npreset = \"" + own.string() + "\"\n"),
              own.string() + ":2" + expected.substr(std::string("scene.toml:7").size()) + "500 x 500");
}

TEST(Messages, PresetsNameTheirOwnFileAndLine) {
    const fs::path preset = fs::temp_directory_path() / "astrosplat preset messages.toml";
    const std::string text = head + "preset = \"" + preset.string() + "\"\n";
    const auto expect_said = [&](const std::string& lines, const std::string& said) {
        write_file_atomically(preset, lines);
        EXPECT_EQ(message(text), preset.string() + ":" + said);
    };
    expect_said("[look]\nalpha.powr = 2\n", "2: unknown key 'alpha.powr'; did you mean 'look.alpha.power'?");
    expect_said("[look]\nalpha.power = -2\n",
                "2: look.alpha.power: expected a number from 0 to 1000000, found -2");
    expect_said("[output]\nfps = 2\n", "2: unknown key 'fps'; 'astrosplat parameters' lists all keys");
    expect_said("astrosplat = 2\n[look]\nalpha.power = 2\n",
                "1: astrosplat: expected the format version 1, found 2");
    expect_said("[look]\nradius = { min = 2.0 }\n",
                "2: layer.stars.look.radius.min: expected min not above max, found 2 and 0");
    fs::remove(preset);
    EXPECT_EQ(message(text), preset.string() +
                                 ": cannot be read: No such file or directory; the looks that come with "
                                 "astrosplat are in " ASTROSPLAT_SOURCE_DIR
                                 "/assets/looks, by name: m51, s106");
}

TEST(Messages, Assignments) {
    const auto expect_said = [](const std::string& assignment, const std::string& said) {
        EXPECT_EQ(message(head, {assignment}), "--set: " + said);
    };
    expect_said("layer.stars.look.alpha.powr=6",
                "unknown key 'layer.stars.look.alpha.powr'; did you mean 'layer.stars.look.alpha.power'?");
    expect_said("layer.star.look.alpha.power=6",
                "layer.star.look.alpha.power: unknown layer 'star'; did you mean 'stars'?");
    expect_said("layer.stars.look.alpha.power=six",
                "layer.stars.look.alpha.power: expected a number, found a string");
    expect_said("layer.stars.look.alpha.power=",
                "layer.stars.look.alpha.power: expected a number, found a string");
    expect_said("layer.stars.look.pdf=gaussian",
                "layer.stars.look.pdf: expected a table, found a string; did you mean "
                "layer.stars.look.pdf.shape=gaussian?");
    expect_said("camera=5",
                "camera: expected a table, found a number; it has keys such as camera.projection");
    expect_said("camera.position=0,0,5",
                "camera.position: expected 3 numbers, found a string; did you mean --set "
                "'camera.position=[0, 0, 5]'?");
    expect_said("output.aovs=[depth]",
                "output.aovs: expected a list of depth, coverage, count or layers, found a string; did you "
                "mean --set 'output.aovs=[\"depth\"]'?");
    expect_said("output.aovs=depht",
                "output.aovs: expected a list of depth, coverage, count or layers, found a string");
    expect_said("layer.stars.look.noise.3.cull=0.5",
                "layer.stars.look.noise.3.cull: expected an index of at most 0 in layer.look.noise, found 3");
    expect_said("output.resoluton=[1,1]",
                "unknown key 'output.resoluton'; did you mean 'output.resolution'?");
    expect_said("output.frames=x", "output.frames: expected frames such as 1-100,120,200-300x2, found 'x'");
    expect_said("layer.stars.name=9",
                "layer.name: expected letters, digits and _ beginning with a letter, found '9'");
    expect_said("animation.camera.fow={keys=[[1,2]]}",
                "unknown key 'camera.fow'; did you mean 'camera.fov'?");
    EXPECT_EQ(message(head, {"output.preset=dom"}),
              "dom: no preset of the output has this name; known are: dome");
    EXPECT_THROW(parse_assignment("nothing"), InputError);
    EXPECT_THROW(parse_assignment("=3"), InputError);
}

}  // namespace
}  // namespace astrosplat::test
