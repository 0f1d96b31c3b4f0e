#include "cross/crossing.h"

#include <fmt/format.h>

#include <queue>
#include <set>

#include "cross/inputs.h"
#include "scene/parameter.h"
#include "support/random_values.h"

namespace astrosplat::test {
namespace {

constexpr std::size_t most_drawn_layers = 4;  // before what is settled

/// Every factor of a scene with the weights of its choices, 1 where there are none. Drawing, counting
/// and naming are loops over these.
void visit_scene(auto& c, const auto& visit) {
    visit("blur", c.blur, {2, 3, 1, 3});
    visit("layer_switched", c.layer_switched, {2, 2, 2, 1});
    visit("sky_switched", c.sky_switched, {2, 2, 2, 1});
    visit("moved", c.moved, {});
    visit("path", c.path, {});
    visit("projection", c.projection, {3});
    visit("seen", c.seen, {3, 1, 1, 2});
    visit("channels", c.channels, {1, 1, 2, 2});
    visit("sky", c.sky, {});
    visit("sky_near", c.sky_near, {});
    visit("assigned", c.assigned, {1, 1, 2, 1, 1, 2});
    visit("streamed", c.streamed, {});
    visit("threads", c.threads, {});
    visit("small_tiles", c.small_tiles, {});
    visit("target", c.target, {});
    visit("folder", c.folder, {});
    visit("token", c.token, {});
    visit("token_in_folder", c.token_in_folder, {2, 1});
    visit("ending", c.ending, {2, 1, 1, 2});
    visit("deep", c.deep, {2, 1});
}

/// Drawn after all else, so that seeds keep their scenes.
void visit_late(auto& c, const auto& visit) {
    visit("device", c.device, {1, 2, 1});
    visit("cut", c.cut, {2, 1});
}

void visit_layer(auto& layer, const auto& visit) {
    visit("source", layer.source, {});
    visit("blend", layer.blend, {});
    visit("isolated", layer.isolated, {2, 1});
    visit("holdout", layer.holdout, {4, 1});
    visit("display", layer.display, {2, 1});
    visit("split", layer.split, {2, 1});
}

using Weights = std::initializer_list<int>;

/// Draws what it visits.
struct Draw {
    Numbers* numbers;
    template <class E>
    void operator()(const char*, E& choice, Weights weights) const {
        const std::size_t count = names_of(E{}).size();
        std::vector<int> shares(weights);
        shares.resize(count, 1);
        int sum = 0;
        for (const int share : shares) sum += share;
        int left = int(numbers->below(std::size_t(sum)));
        std::size_t level = 0;
        while (left >= shares[level]) left -= shares[level++];
        choice = static_cast<E>(level);
    }
};

bool has_picture(const CrossingLayer& layer) {
    return layer.source == Source::mesh || layer.source == Source::bodies;
}

bool has_source(const Crossing& c, Source source) {
    return std::ranges::find(c.layers, source, &CrossingLayer::source) != c.layers.end();
}

void settle(Crossing& c) {
    if (c.seen == Seen::pair && !has_two_eyes(c.projection)) c.seen = Seen::centre;
    if (c.ending == Ending::tif || c.ending == Ending::png) c.channels = Channels::none;
    if (c.path == CameraPath::automatic)  // random stars lie along a path
        for (CrossingLayer& layer : c.layers)
            if (layer.source == Source::random_stars) layer.source = Source::catalogue;
    if (has_source(c, Source::picture_stars) && std::ranges::none_of(c.layers, has_picture))
        c.layers.emplace_back();
    if (c.streamed == Answer::no) return;
    if (!has_source(c, Source::native)) c.layers.emplace_back().source = Source::native;
    for (CrossingLayer& layer : c.layers)  // display values are made of all splats at once
        if (layer.source == Source::native) layer.display = Answer::no;
}

bool can_meet(const std::string& a, const std::string& b) {
    const auto are = [&](const char* one, const char* other) {
        return (a == one && b == other) || (a == other && b == one);
    };
    for (const char* const channels : {"channels depth", "channels layers", "channels all"})
        if (are(channels, "ending tif") || are(channels, "ending png")) return false;
    return !are("seen pair", "projection orthographic") && !are("seen pair", "projection fisheye") &&
           !are("path automatic", "source random_stars");
}

// --- what is written ---

std::string path_text(const std::string& name) { return to_toml(input(name).string()); }

std::string like_text(const Crossing& c) {
    const auto picture = std::ranges::find_if(c.layers, has_picture);
    return layer_name(std::size_t(picture - c.layers.begin()));
}

std::string mesh_text(const char* shape, const char* picture, const char* more) {
    return fmt::format("meshes = [ {{ mesh = \"{}\", texture = {} }} ]\nmax_distance = 0.4\n{}\n", shape,
                       path_text(picture), more);
}

std::string bodies_text(std::uint32_t kind, bool detailed) {
    const char* const structures[] = {"sheet\"", "walls\"", "disk\"", "axis\", tilt = 20.0"};
    return mesh_text("plane", kind % 2 ? "shell.ppm" : "small.ppm",
                     fmt::format("count = 300\nstructure = {{ kind = \"{}{} }}", structures[kind],
                                 detailed ? ", detail = 1, detail_tiles = \"01 10\"" : "")
                         .c_str());
}

std::string source_text(const Crossing& c, const CrossingLayer& layer) {
    switch (layer.source) {
        case Source::mesh:
            return mesh_text("sphere", "picture.ppm", "count = 300");
        case Source::bodies:
            return bodies_text(c.seed % 2 + (&layer == &c.layers.front() ? 0 : 2), c.seed / 2 % 2 == 1);
        case Source::table:
            return "kind = \"splats\"\nfile = " + path_text("table.pda") + "\n";
        case Source::native:
            return "kind = \"splats\"\nfile = " + path_text("native.splats") + "\n";
        case Source::gaussians:
            return "kind = \"splats\"\nfile = " + path_text("gaussians.ply") + "\n";
        case Source::catalogue:
            return "kind = \"stars\"\ncatalogue = " + path_text("catalogue.csv") + "\n";
        case Source::random_stars:
            return "kind = \"stars\"\nalong = \"camera\"\ncount = 150\nspread = 6.0\n";
        case Source::picture_stars:
            return fmt::format("kind = \"stars\"\ncatalogue = {}\nlike = \"{}\"\n", path_text("stars.csv"),
                               like_text(c));
    }
    return "";
}

std::string layer_text(const Crossing& c, std::size_t index) {
    const CrossingLayer& layer = c.layers[index];
    const bool hidden = index == 0 && c.layer_switched == Switched::hidden;
    std::string text = fmt::format("\n[[layer]]\nname = \"{}\"\n{}[layer.source]\n", layer_name(index),
                                   hidden ? "visible = false\n" : "");
    text += source_text(c, layer);
    const bool is_cut = c.cut == Answer::yes && index + 1 == c.layers.size();
    if (has_picture(layer) || is_cut) text += "[layer.look]\n";
    if (has_picture(layer)) text += "radius = { min = 0.1, max = 0.4 }\n";
    if (is_cut)
        text +=
            "crop = [{ shape = \"outline\", center = [0.3, 0.2, 5], outline = \"M -.5 -.4 .4 -.5 .1 .5\", "
            "soft = 0.3 "
            "}, { shape = \"outline\", keep = \"outside\", center = [0.3, 0.2, 5], width = 0.05, outline = "
            "\"M -.1 0 "
            ".1 .05 M 0 -.1 0 0\" }]\n";
    text += fmt::format("[layer.render]\nblend = \"{}\"\n", name_of(layer.blend));
    if (layer.isolated == Answer::yes) text += "isolate = true\n";
    if (layer.holdout == Answer::yes) text += "holdout = true\n";
    if (layer.display == Answer::yes) text += "space = \"display\"\n";
    if (layer.split == Answer::yes) text += "lod = { max_px = 200.0, max_children = 4 }\n";
    return text;
}

std::string camera_text(const Crossing& c) {
    std::string text = fmt::format("\n[camera]\nprojection = \"{}\"\n", name_of(c.projection));
    if (c.path == CameraPath::still || c.path == CameraPath::keys)
        text += "position = [0.6, 1.2, 6.0]\ntarget = [0.1, 0.0, 0.0]\nroll = 10.0\n";
    if (c.path == CameraPath::chan_file) text += "file = " + path_text("way.chan") + "\n";
    if (c.path == CameraPath::csv_file) text += fmt::format("file = \"{}\"\n", camera_table_name);
    if (c.projection == Projection::orthographic) text += "height = 6.0\n";
    if (c.blur == Blur::shutter || c.blur == Blur::both) text += "shutter = 180.0\n";
    if (c.blur == Blur::lens || c.blur == Blur::both) text += "f_number = 0.5\nunit_mm = 100.0\n";
    if (c.seen == Seen::left || c.seen == Seen::right) text += fmt::format("eye = \"{}\"\n", name_of(c.seen));
    if (c.seen != Seen::centre) text += "eye_separation = 0.3\n";
    return text;
}

std::string sky_text(const Crossing& c) {
    if (c.sky == Sky::none) return "";
    std::string text = "\n[environment]\n";
    if (c.sky == Sky::image) text += "image = " + path_text("sky.ppm") + "\n";
    if (c.sky == Sky::tile) text += "tile = " + path_text("field.ppm") + "\ntile_px = 64\n";
    if (c.sky == Sky::cube) {
        std::vector<std::string> faces;
        for (int i = 0; i < 6; ++i) faces.push_back(path_text(fmt::format("face{}.ppm", i)));
        text += fmt::format("cube = [{}]\n", fmt::join(faces, ", "));
    }
    if (c.sky_near == Answer::yes) text += "behind = 20.0\n";
    if (c.sky_switched == Switched::hidden) text += "visible = false\n";
    return text;
}

std::string switched_text(const std::string& key, Switched switched) {
    if (switched != Switched::off_inside && switched != Switched::on_inside) return "";
    return fmt::format("\"{}\" = {{ keys = [[1, {}], [5.1, {}]] }}\n", key, switched == Switched::off_inside,
                       switched == Switched::on_inside);
}

std::string moved_text(const Crossing& c) {
    const std::size_t last = c.layers.size() - 1;
    const auto track = [&](const char* key, const char* first, const char* second) {
        return fmt::format("\"layer.{}.{}\" = {{ keys = [[1, {}], {}] }}\n", layer_name(last), key, first,
                           second);
    };
    switch (c.moved) {
        case Moved::nothing:
            return "";
        case Moved::gain:
            return track("look.grade.gain", "0.3", "[9, 2.0]");
        case Moved::density:
            return track("look.density", "0.2", "[9, 1.0]");
        case Moved::turn:
            return track("transform.rotate", "[0, 0, 0]", "[9, [0, 200, 40]]");
        case Moved::blend:
            return track("render.blend", "\"over\"", "[5.1, \"add\"]");
        case Moved::isolate:
            return track("render.isolate", "false", "[5.1, true]");
    }
    return "";
}

std::string animation_text(const Crossing& c) {
    std::string text = switched_text("layer." + layer_name(0) + ".visible", c.layer_switched);
    if (c.sky != Sky::none) text += switched_text("environment.visible", c.sky_switched);
    text += moved_text(c);
    if (c.path == CameraPath::keys)
        text +=
            "\"camera.position\" = { keys = [[1, [-1.5, 1.0, 6.0]], [9, [1.5, 1.0, 6.5]]] }\n"
            "\"camera.fov\" = { keys = [[1, 40.0], [9, 50.0]] }\n";
    return text.empty() ? "" : "\n[animation]\n" + text;
}

std::string channels_text(Channels channels) {
    switch (channels) {
        case Channels::none:
            return "[]";
        case Channels::depth:
            return "[\"depth\"]";
        case Channels::layers:
            return "[\"layers\"]";
        case Channels::all:
            return "[\"depth\", \"coverage\", \"count\", \"layers\"]";
    }
    return "";
}

/// A movie is made of frames of its own, apart from those that the scene is rendered to.
const char* ending_text(Ending ending) {
    return ending == Ending::tif ? ".tif" : ending == Ending::png ? ".png" : ".exr";
}

const char* token_text(Token token) {
    switch (token) {
        case Token::hashes:
            return ".####";
        case Token::percent:
            return ".%04d";
        case Token::braces:
            return ".{frame:04}";
        case Token::none:
            return "";
    }
    return "";
}

/// Below the scene's folder, with what stands for the eye and the number put in.
std::string name_with(const Crossing& c, const std::string& eye, const std::string& number) {
    const char* const between = c.token_in_folder == Answer::yes ? "/shot" : "";
    return fmt::format("frames/shot{}{}{}{}", eye, number, between, ending_text(c.ending));
}

// --- what meets ---

/// The names of all choices of a factor, in their order.
struct AddNames {
    std::vector<std::string>* names;
    template <class E>
    void operator()(const char* factor, const E&, Weights) const {
        for (const std::string_view name : names_of(E{}))
            names->push_back(fmt::format("{} {}", factor, name));
    }
};

/// The choice of every factor that is visited, as an index into feature_names() from `first` on.
struct AddChoices {
    std::vector<int>* choices;
    int* first;
    template <class E>
    void operator()(const char*, const E& choice, Weights) const {
        choices->push_back(*first + int(choice));
        *first += int(names_of(E{}).size());
    }
};

std::vector<int> choices_of(const Crossing& c, int& first) {
    std::vector<int> choices;
    visit_scene(c, AddChoices{&choices, &first});
    visit_late(c, AddChoices{&choices, &first});
    return choices;
}

std::vector<int> choices_of(const CrossingLayer& layer, int first) {
    std::vector<int> choices;
    visit_layer(layer, AddChoices{&choices, &first});
    return choices;
}

void add_pairs(const std::vector<int>& a, const std::vector<int>& b, std::vector<FeaturePair>& pairs) {
    for (const int one : a)
        for (const int other : b) pairs.emplace_back(one, other);
}

void add_pairs_within(const std::vector<int>& choices, std::vector<FeaturePair>& pairs) {
    for (std::size_t i = 0; i < choices.size(); ++i)
        for (std::size_t k = i + 1; k < choices.size(); ++k) pairs.emplace_back(choices[i], choices[k]);
}

std::string factor_of(const std::string& feature) { return feature.substr(0, feature.find(' ')); }

}  // namespace

Crossing crossing_of(std::uint32_t seed) {
    Crossing c;
    c.seed = seed;
    Numbers numbers(seed);
    visit_scene(c, Draw{&numbers});
    c.layers.resize(1 + numbers.below(most_drawn_layers));
    for (CrossingLayer& layer : c.layers) visit_layer(layer, Draw{&numbers});
    Draw{&numbers}("scaled", c.scaled, {});  // after all else, as the device; in no pair
    visit_late(c, Draw{&numbers});
    settle(c);
    return c;
}

std::string layer_name(std::size_t index) { return std::string(1, char('a' + index)); }

std::string folder_name(const Crossing& c) {
    switch (c.folder) {
        case Folder::plain:
            return "scene";
        case Folder::tokens:
            return "C# 100%v {frame}";
        case Folder::blanks:
            return " two  blanks ";
        case Folder::umlauts:
            return "Größe äöü";
        case Folder::percent:
            return "%04d [1]*";
    }
    return "";
}

std::string output_path(const Crossing& c) {
    return name_with(c, c.seen == Seen::pair ? ".%V" : "", token_text(c.token));
}

fs::path file_of_frame(const Crossing& c, std::int64_t frame, Eye eye) {
    return name_with(c, c.seen == Seen::pair ? "." + std::string(name_of(eye)) : "",
                     c.token == Token::none ? "" : fmt::format(".{:04}", frame));
}

fs::path folder_of_movie(const Crossing& c) {
    const bool has_places = c.token != Token::none || c.seen == Seen::pair;
    return c.token_in_folder == Answer::yes && !has_places ? "frames/shot" : "frames";
}

std::vector<std::int64_t> frames_of(const Crossing& c) {
    if (c.token == Token::none) return {crossing_frame};
    return {crossing_frame, crossing_frame + 1};
}

std::vector<Eye> eyes_of(const Crossing& c) {
    if (c.seen == Seen::pair) return {Eye::left, Eye::right};
    return {static_cast<Eye>(c.seen)};
}

std::string scene_text(const Crossing& c) {
    std::string text = fmt::format(
        "astrosplat = 1\n\n# crossing {}\n[output]\nresolution = [{}, {}]  # small\nframes = \"{}\"\n"
        "path = {}\naovs = {}\nsamples = {}\n",
        c.seed, crossing_width, crossing_height, fmt::format("{}", fmt::join(frames_of(c), ",")),
        to_toml(output_path(c)), channels_text(c.channels), 2 + c.seed % 3);
    if (c.deep == Answer::yes)
        text += fmt::format("depth = \"{}\"\n", c.ending == Ending::png ? "16" : "float");
    if (c.scaled == Answer::yes) text += "\n[scene]\nlight_years_per_unit = 5.0\n";
    text += camera_text(c) + sky_text(c);
    for (std::size_t i = 0; i < c.layers.size(); ++i) text += layer_text(c, i);
    return text + animation_text(c);
}

std::string camera_table(const Crossing& c) {
    if (c.path != CameraPath::csv_file) return "";
    const std::string key = "layer." + layer_name(0) + ".look.grade.gain";
    std::string text =
        "frame,camera.position.x,camera.position.y,camera.position.z,camera.fov,camera.roll," + key + "\n";
    for (int frame = 1; frame <= 9; ++frame)
        text += fmt::format("{},{},1.0,6.0,{},{},{}\n", frame, 0.3 * (frame - 5), 40 + frame, 3 * frame,
                            0.2 * frame);
    return text;
}

const std::vector<std::string>& feature_names() {
    static const std::vector<std::string> all = [] {
        std::vector<std::string> names;
        const Crossing scene;
        const CrossingLayer layer;
        visit_scene(scene, AddNames{&names});
        visit_late(scene, AddNames{&names});
        visit_layer(layer, AddNames{&names});
        return names;
    }();
    return all;
}

std::vector<FeaturePair> pairs_of(const Crossing& c) {
    std::vector<FeaturePair> pairs;
    int first_of_layers = 0;
    const std::vector<int> scene = choices_of(c, first_of_layers);
    add_pairs_within(scene, pairs);
    for (const CrossingLayer& layer : c.layers) {
        const std::vector<int> own = choices_of(layer, first_of_layers);
        add_pairs(scene, own, pairs);
        add_pairs_within(own, pairs);
    }
    return pairs;
}

std::vector<FeaturePair> possible_pairs() {
    const std::vector<std::string>& names = feature_names();
    std::vector<FeaturePair> pairs;
    for (std::size_t a = 0; a < names.size(); ++a)
        for (std::size_t b = a + 1; b < names.size(); ++b)
            if (factor_of(names[a]) != factor_of(names[b]) && can_meet(names[a], names[b]))
                pairs.emplace_back(int(a), int(b));
    return pairs;
}

/// The gain of a seed never grows while others are taken, so only the best few are counted again.
std::vector<std::uint32_t> covering_seeds(const std::vector<FeaturePair>& wanted, std::uint32_t pool) {
    const std::size_t features = feature_names().size();
    std::vector<char> is_new(features * features, 0);
    std::size_t left = 0;
    const auto at = [&](const FeaturePair& pair) -> char& {
        return is_new[std::size_t(pair.first) * features + std::size_t(pair.second)];
    };
    for (const FeaturePair& pair : wanted) at(pair) = 1, ++left;
    std::vector<std::vector<FeaturePair>> pairs;
    for (std::uint32_t seed = 0; seed < pool; ++seed) pairs.push_back(pairs_of(crossing_of(seed)));
    const auto gain_of = [&](std::uint32_t seed) {
        std::set<FeaturePair> gained;
        for (const FeaturePair& pair : pairs[seed])
            if (at(pair)) gained.insert(pair);
        return gained.size();
    };
    std::priority_queue<std::pair<std::size_t, std::uint32_t>> queue;
    for (std::uint32_t seed = 0; seed < pool; ++seed) queue.emplace(gain_of(seed), seed);
    std::vector<std::uint32_t> taken;
    while (left > 0 && !queue.empty()) {
        const std::uint32_t seed = queue.top().second;
        queue.pop();
        const std::size_t gain = gain_of(seed);
        if (gain == 0) continue;
        if (!queue.empty() && gain < queue.top().first) {
            queue.emplace(gain, seed);
            continue;
        }
        taken.push_back(seed);
        left -= gain;
        for (const FeaturePair& pair : pairs[seed]) at(pair) = 0;
    }
    return taken;
}

}  // namespace astrosplat::test
