// Small scenes in which features of every kind meet, each drawn from one number by pure functions. In: a
// seed. Out: what was drawn, as plain values; the text of its scene; what its files are called; and which
// pairs of features meet in it, so that a test can prove that all of them do.
#pragma once

#include "camera/camera.h"
#include "core/text.h"
#include "render/frame.h"

namespace astrosplat::test {

enum class Answer { no, yes };
constexpr auto names_of(Answer) { return names_up_to<Answer::yes>("no", "yes"); }

enum class Source { mesh, bodies, table, native, gaussians, catalogue, random_stars, picture_stars };
constexpr auto names_of(Source) {
    return names_up_to<Source::picture_stars>("mesh", "bodies", "table", "native", "gaussians", "catalogue",
                                              "random_stars", "picture_stars");
}

enum class Blur { none, shutter, lens, both };
constexpr auto names_of(Blur) { return names_up_to<Blur::both>("none", "shutter", "lens", "both"); }

/// Of a key that is true or false: keyed so that it changes while the shutter is open, or does not change.
enum class Switched { still, off_inside, on_inside, hidden };
constexpr auto names_of(Switched) {
    return names_up_to<Switched::hidden>("still", "off_inside", "on_inside", "hidden");
}

/// The animated part of a layer: values that slide, and choices that change while the shutter is open.
enum class Moved { nothing, gain, density, turn, blend, isolate };
constexpr auto names_of(Moved) {
    return names_up_to<Moved::isolate>("nothing", "gain", "density", "turn", "blend", "isolate");
}

enum class CameraPath { still, automatic, keys, chan_file, csv_file };
constexpr auto names_of(CameraPath) {
    return names_up_to<CameraPath::csv_file>("still", "automatic", "keys", "chan_file", "csv_file");
}

enum class Seen { centre, left, right, pair };
constexpr auto names_of(Seen) { return names_up_to<Seen::pair>("centre", "left", "right", "pair"); }

enum class Channels { none, depth, layers, all };
constexpr auto names_of(Channels) { return names_up_to<Channels::all>("none", "depth", "layers", "all"); }

enum class Sky { none, image, cube, tile };
constexpr auto names_of(Sky) { return names_up_to<Sky::tile>("none", "image", "cube", "tile"); }

/// The key that the command line sets: the lens, which camera files have too, or any of a group.
enum class Assigned { nothing, fov, camera, environment, output, layer };
constexpr auto names_of(Assigned) {
    return names_up_to<Assigned::layer>("nothing", "camera.fov", "camera", "environment", "output", "layer");
}

enum class Target { best, least, between };
constexpr auto names_of(Target) { return names_up_to<Target::between>("best", "least", "between"); }

/// What draws: as --device has it.
enum class Device { cpu, gpu, automatic };
constexpr auto names_of(Device) { return names_up_to<Device::automatic>("cpu", "gpu", "auto"); }

enum class Folder { plain, tokens, blanks, umlauts, percent };
constexpr auto names_of(Folder) {
    return names_up_to<Folder::percent>("plain", "tokens", "blanks", "umlauts", "percent");
}

/// How the frame's number stands in the name of its file.
enum class Token { hashes, percent, braces, none };
constexpr auto names_of(Token) { return names_up_to<Token::none>("hashes", "percent", "braces", "none"); }

enum class Ending { exr, tif, png, movie };
constexpr auto names_of(Ending) { return names_up_to<Ending::movie>("exr", "tif", "png", "movie"); }

struct CrossingLayer {
    Source source = Source::mesh;
    Blend blend = Blend::over;
    Answer isolated = Answer::no, holdout = Answer::no;
    Answer display = Answer::no;  // mixed in display values, where the rest allows it
    Answer split = Answer::no;    // by level of detail
};

struct Crossing {
    std::uint32_t seed = 0;
    Blur blur = Blur::none;
    Switched layer_switched = Switched::still, sky_switched = Switched::still;  // of the first layer
    Moved moved = Moved::nothing;                                               // of the last layer
    CameraPath path = CameraPath::still;
    Projection projection = Projection::perspective;
    Seen seen = Seen::centre;
    Channels channels = Channels::none;
    Sky sky = Sky::none;
    Answer sky_near = Answer::no;
    Assigned assigned = Assigned::nothing;
    Answer streamed = Answer::no;  // layers of native files stay on disk
    Answer threads = Answer::no;   // several
    Answer small_tiles = Answer::no;
    Target target = Target::best;
    Device device = Device::cpu;
    Answer cut = Answer::no;  // the last layer, by outlines that were drawn in a view
    Folder folder = Folder::plain;
    Token token = Token::hashes;
    Answer token_in_folder = Answer::no;  // the places stand in a folder's name, not in the file's
    Ending ending = Ending::exr;
    Answer deep = Answer::no;           // more bits than usual
    Answer scaled = Answer::no;         // a unit has a length in the sky, by which stars are placed
    std::vector<CrossingLayer> layers;  // 1 to 4
};

/// The same crossing for the same seed on every machine. What cannot be is settled: stars of a picture get
/// one, what is streamed is a native file.
Crossing crossing_of(std::uint32_t seed);

/// The frame that crossings are rendered at, and the width and height of frames, px.
inline constexpr std::int64_t crossing_frame = 5, crossing_width = 48, crossing_height = 32;

std::string layer_name(std::size_t index);
/// The name of the folder that its scene lies in.
std::string folder_name(const Crossing& crossing);
/// The scene's text, and that of the table that is its camera file beside it; empty: none.
std::string scene_text(const Crossing& crossing);
std::string camera_table(const Crossing& crossing);
inline constexpr const char* camera_table_name = "way.csv";

/// output.path, and the file of a frame in the scene's folder as a person reads the pattern.
std::string output_path(const Crossing& crossing);
fs::path file_of_frame(const Crossing& crossing, std::int64_t frame, Eye eye);
/// The innermost folder that all of them lie in.
fs::path folder_of_movie(const Crossing& crossing);
/// The frames that it asks for, and the eyes of every one.
std::vector<std::int64_t> frames_of(const Crossing& crossing);
std::vector<Eye> eyes_of(const Crossing& crossing);

/// Two choices that meet, as indices into feature_names(): of two factors of the scene, of the scene and one
/// of its layers, or of one and the same layer.
using FeaturePair = std::pair<int, int>;
std::vector<FeaturePair> pairs_of(const Crossing& crossing);
/// All that can meet.
std::vector<FeaturePair> possible_pairs();
const std::vector<std::string>& feature_names();

/// Few seeds that together meet every pair wanted, found greedily among the first `pool`.
std::vector<std::uint32_t> covering_seeds(const std::vector<FeaturePair>& wanted, std::uint32_t pool);

}  // namespace astrosplat::test
