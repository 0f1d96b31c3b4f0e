// From TOML to parameters and tracks, for scenes, presets and --set alike. In: TOML text. Out: tables with
// line numbers, flattened into entries "key = value" with their places, and written into whatever a
// Description describes; the tracks of [animation]. Include in .cpp files only: toml++ is large.
#pragma once

#include <toml++/toml.h>

#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

/// Parses TOML; `name` and the line begin every message. Throws InputError.
toml::table parse_toml(const std::string& text, const std::string& name);

/// A leaf as a Value. Throws ValueError for tables and dates.
Value value_of(const toml::node& node);

/// "a table", "a date", or as kind_of(Value).
std::string kind_of(const toml::node& node);

/// An array that lists tables ([[x]] or [ {...}, ... ]); an empty array does not.
const toml::array* list_of_tables(const toml::node& node);

/// "FILE:LINE" of a node or key.
std::string place_of(const std::string& name, const toml::source_region& source);

struct Entry {
    enum class Kind { leaf, table, list };
    Kind kind = Kind::leaf;
    ParameterKey key;          // full: "layer.stars.look.noise.1.cull"
    ParameterKey generic_key;  // as the section of the file has it: "layer.look.noise.1.cull"
    std::string place;         // "scene.toml:12", "--set"
    toml::source_position position{};
    const toml::node* node = nullptr;  // lives as long as the parsed table
    const std::string* raw = nullptr;  // --set: the text as typed
};

/// Where entries come from: how their paths are read, and how their keys are shown.
struct EntryOrigin {
    std::string name;                    // the file
    fs::path folder;                     // of its paths
    bool command_line = false;           // full keys in messages; paths of frame files become absolute
    ParameterKey layer_group = "layer";  // what "layer" of the manual's keys is called here; empty: a preset
};

/// Adds the node and all below it.
void flatten(const toml::node& node, const ParameterKey& key, const ParameterKey& generic_key,
             const EntryOrigin& origin, const toml::source_region& source, std::vector<Entry>& entries);

/// Writes the entries in the order they stand in the file; lists get their lengths first. `describe_target`
/// is called again after lengths changed. Throws InputError naming the entry's place.
void apply_entries(std::vector<Entry> entries, const EntryOrigin& origin,
                   const std::function<Description()>& describe_target, Places& places);

/// Makes the first list that is too short for `key` longer by one element, and says so: `description` is then
/// out of date. Throws ValueError for an index beyond that.
bool extend_lists(const Description& description, const ParameterKey& key);

/// Why the scene has no parameter of a key: "unknown key 'x'; did you mean 'y'?" or "KEY: unknown layer 'x';
/// did you mean 'y'?".
std::string why_unknown(const Scene& scene, const ParameterKey& key);

// The [animation] table.

/// Reads one track and checks it against the parameter it animates. Lists of the scene grow where a key names
/// their next element (noise.cull where no noise is set). `place` begins every message. Throws InputError.
Track read_track(const ParameterKey& key, const toml::node& node, Scene& scene, const std::string& place);

/// Reads all of [animation], in the order of the file.
std::vector<Track> read_tracks(const toml::table& table, Scene& scene, const std::string& file);

/// The numbers of a keyframe's value, which is checked by setting the parameter. Throws ValueError where it
/// does not fit, and where it is none or a quaternion of zeros.
std::vector<double> keyframe_numbers(const Parameter& parameter, const Value& value);

/// "{ keys = [[1, 0.5], ...], interpolation = "smooth" }"
std::string track_to_toml(const Track& track, const ParameterSpec& spec);

}  // namespace astrosplat
