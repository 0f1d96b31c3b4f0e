// Tracks of keyframes as scenes write them, and their messages.
#include "scene/entries.h"

#include <fmt/format.h>

#include "camera/keyframe.h"
#include "core/error.h"
#include "scene/describe.h"
#include "scene/parameter_key.h"

namespace astrosplat {
namespace {

// The handles of a keyframe as scenes write them, the fourth part of
//
//     [frame, value, "bezier", { in = [-8, 0.2], out = "flat", broken = true }]
//
// in and out are "auto" (also where they are left out), "flat", or [frames, value] from the keyframe, with as
// many numbers as its value has; "flat" in place of the table is both. They shape the Bezier segments before
// and after the keyframe; broken: a person shapes them one by one.

/// Where a track stands, for messages.
struct TrackPlace {
    std::string place;
    ParameterKey key;
    [[noreturn]] void fail(const std::string& message) const {
        throw InputError(fmt::format("{}: {}: {}", place, key, message));
    }
};

/// Words for a node that stands where another value was expected.
std::string found_in(const toml::node& node) {
    const auto* text = node.as_string();
    return text ? "'" + text->get() + "'" : kind_of(node);
}

bool read_boolean(const toml::node& node, std::string_view name, const TrackPlace& at) {
    if (!node.is_boolean()) at.fail(fmt::format("{}: expected true or false, found {}", name, kind_of(node)));
    return node.as_boolean()->get();
}

const std::vector<std::string> handle_settings{"in", "out", "broken"};

/// "[frames, value]" of a handle: as many numbers as the keyframe has, on its own side of it.
Handle<std::vector<double>> read_free_handle(const toml::array& parts, std::size_t numbers, bool before,
                                             const TrackPlace& at) {
    const std::string what = before ? "in" : "out";
    const auto number = [&](const toml::node& node) {
        const auto found = node.value<double>();
        if (!found || !node.is_number() || !(std::fabs(*found) <= largest_number))
            at.fail(fmt::format("{}: expected a finite number in a handle, found {}", what, kind_of(node)));
        return *found;
    };
    if (parts.size() != 2)
        at.fail(
            fmt::format("{}: expected [frames, value] from the keyframe, found {}", what, kind_of(parts)));
    Handle<std::vector<double>> handle{HandleKind::free, number(parts[0]), {}};
    if (before ? handle.frames > 0.0 : handle.frames < 0.0)
        at.fail(fmt::format("{}: expected {} frames, found {}", what, before ? "0 or negative" : "0 or more",
                            short_number(handle.frames)));
    if (const toml::array* list = parts[1].as_array())
        for (const toml::node& node : *list) handle.value.push_back(number(node));
    else
        handle.value.push_back(number(parts[1]));
    if (handle.value.size() != numbers)
        at.fail(fmt::format("{}: expected as many numbers as the keyframe's value has, {}, found {}", what,
                            numbers, handle.value.size()));
    return handle;
}

Handle<std::vector<double>> read_handle(const toml::node& node, std::size_t numbers, bool before,
                                        const TrackPlace& at) {
    if (const toml::array* parts = node.as_array()) return read_free_handle(*parts, numbers, before, at);
    const auto* text = node.as_string();
    if (text && text->get() == "auto") return {};
    if (text && text->get() == "flat") return {HandleKind::flat, 0.0, {}};
    at.fail(fmt::format("{}: expected auto, flat or [frames, value], found {}", before ? "in" : "out",
                        found_in(node)));
}

std::string handle_to_toml(const Handle<std::vector<double>>& handle) {
    if (handle.kind == HandleKind::automatic) return "\"auto\"";
    if (handle.kind == HandleKind::flat) return "\"flat\"";
    Value::List numbers(handle.value.begin(), handle.value.end());
    return fmt::format("[{}, {}]", short_number(handle.frames),
                       to_toml(numbers.size() == 1 ? numbers[0] : Value(std::move(numbers))));
}

/// Reads them into a keyframe that has its value. Throws InputError.
void read_handles(const toml::node& node, Keyframe<std::vector<double>>& keyframe, const TrackPlace& at) {
    const std::size_t numbers = keyframe.value.size();
    const toml::table* table = node.as_table();
    if (!table) {
        const auto* text = node.as_string();
        if (!text || text->get() != "flat")
            at.fail(
                fmt::format("expected handles \"flat\" or {{ in = [frames, value], out = ... }}, found {}",
                            found_in(node)));
        keyframe.in.kind = keyframe.out.kind = HandleKind::flat;
        return;
    }
    for (const auto& [name, part] : *table) {
        if (name == "in")
            keyframe.in = read_handle(part, numbers, true, at);
        else if (name == "out")
            keyframe.out = read_handle(part, numbers, false, at);
        else if (name == "broken")
            keyframe.broken = read_boolean(part, "broken", at);
        else
            at.fail(fmt::format("unknown key '{}' of a keyframe{}", name.str(),
                                did_you_mean(std::string(name.str()), handle_settings)));
    }
}

/// Empty where both are automatic.
std::string handles_to_toml(const Keyframe<std::vector<double>>& keyframe) {
    const auto both = [&](HandleKind kind) { return keyframe.in.kind == kind && keyframe.out.kind == kind; };
    if (both(HandleKind::automatic) && !keyframe.broken) return "";
    if (both(HandleKind::flat) && !keyframe.broken) return "\"flat\"";
    std::string text;
    const auto add = [&](const char* name, const std::string& value) {
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name, value);
    };
    if (keyframe.in.kind != HandleKind::automatic) add("in", handle_to_toml(keyframe.in));
    if (keyframe.out.kind != HandleKind::automatic) add("out", handle_to_toml(keyframe.out));
    if (keyframe.broken) add("broken", "true");
    return "{ " + text + " }";
}

const std::vector<std::string> track_settings{"keys", "interpolation", "ends", "constant_speed"};

template <NamedEnum E>
E read_name(const toml::node& node, const std::string& what, const TrackPlace& at) {
    const std::vector<std::string> names = all_names<E>();
    const auto* text = node.as_string();
    const auto found = std::ranges::find(names, text ? text->get() : "");
    if (found != names.end()) return static_cast<E>(found - names.begin());
    at.fail(fmt::format("{}: expected {}, found {}{}", what, fmt::join(names, ", "), found_in(node),
                        text ? did_you_mean(text->get(), names) : ""));
}

void check_bezier(Interpolation way, const ParameterSpec& spec, const TrackPlace& at) {
    if (way == Interpolation::bezier && spec.type == ParameterType::rotation)
        at.fail("expected linear, smooth or step for a rotation, found bezier");
}

Keyframe<std::vector<double>> read_keyframe(const toml::node& node, const Parameter& parameter,
                                            const Track& track, const TrackPlace& at) {
    const toml::array* parts = node.as_array();
    if (!parts || parts->size() < 2 || parts->size() > 4)
        at.fail(fmt::format("expected keyframes [frame, value] or [frame, value, \"smooth\"], found {}",
                            kind_of(node)));
    const auto frame = (*parts)[0].value<double>();
    if (!frame || !(*parts)[0].is_number() || !std::isfinite(*frame))
        at.fail(fmt::format("expected a frame number first in a keyframe, found {}", kind_of((*parts)[0])));
    Keyframe<std::vector<double>> keyframe{*frame, {}, track.interpolation, {}, {}};
    try {
        keyframe.value = keyframe_numbers(parameter, value_of((*parts)[1]));
    } catch (const ValueError& error) {
        at.fail(fmt::format("frame {}: {}", short_number(*frame), error.what()));
    }
    if (parts->size() > 2)
        keyframe.interpolation = read_name<Interpolation>((*parts)[2], "the way to the next keyframe", at);
    check_bezier(keyframe.interpolation, parameter.spec, at);
    if (parts->size() == 4) read_handles((*parts)[3], keyframe, at);
    return keyframe;
}

void check_order(const Track& track, const TrackPlace& at) {
    for (std::size_t i = 1; i < track.keyframes.size(); ++i) {
        const double before = track.keyframes[i - 1].frame, frame = track.keyframes[i].frame;
        if (frame == before)
            at.fail(fmt::format("expected each frame once, found {} twice", short_number(frame)));
        if (frame < before)
            at.fail(fmt::format("expected ascending frames, found {} after {}", short_number(frame),
                                short_number(before)));
        if (track.keyframes[i].value.size() != track.keyframes[0].value.size())
            at.fail("expected as many points in every keyframe, found another number");
    }
}

void read_settings(const toml::table& table, const ParameterSpec& spec, Track& track, const TrackPlace& at) {
    for (const auto& [name, node] : table) {
        const std::string key(name.str());
        if (key == "interpolation")
            track.interpolation = read_name<Interpolation>(node, key, at);
        else if (key == "ends")
            track.ends = read_name<Ends>(node, key, at);
        else if (key == "constant_speed") {
            track.constant_speed = read_boolean(node, key, at);
            if (track.constant_speed && spec.type != ParameterType::position)
                at.fail("constant_speed: expected it on a position, found it on another parameter");
        } else if (key != "keys") {
            at.fail(fmt::format("unknown key '{}'{}", key, did_you_mean(key, track_settings)));
        }
    }
}

/// The animatable parameter of a key in a copy of the scene, or an error that helps.
const Parameter& animated_parameter(const Description& description, const Scene& scene,
                                    const TrackPlace& at) {
    if (const Parameter* parameter = find_parameter(description, at.key)) {
        if (parameter->spec.animation == Animation::no) at.fail("this parameter cannot be animated");
        return *parameter;
    }
    throw InputError(fmt::format("{}: {}", at.place, why_unknown(scene, at.key)));
}

}  // namespace

std::vector<double> keyframe_numbers(const Parameter& parameter, const Value& value) {
    parameter.set(value);
    std::vector<double> numbers = to_numbers(parameter.spec, value);
    const bool zero = std::ranges::count(numbers, 0.0) == std::ssize(numbers);
    if (zero && parameter.spec.type == ParameterType::rotation)
        throw ValueError("expected a quaternion that is not zero, found 0, 0, 0, 0");
    if (numbers.empty() || (value.text() && value == parameter.spec.nothing))
        throw ValueError(fmt::format("expected {}, found none", expectation(parameter.spec)));
    return numbers;
}

Track read_track(const ParameterKey& key, const toml::node& node, Scene& scene, const std::string& place) {
    const TrackPlace at{place, key};
    try {
        extend_lists(describe(scene), key);
    } catch (const ValueError& error) {
        at.fail(error.what());
    }
    Scene scratch = scene;  // keyframes are checked by setting them
    const Description description = describe(scratch);
    const toml::table* table = node.as_table();
    const toml::array* keyframes = table && table->contains("keys") ? (*table)["keys"].as_array() : nullptr;
    if (table && !table->contains("keys") && !find_parameter(description, key))
        at.fail("expected the whole key in quotes, such as \"camera.position\", found a table");
    const Parameter& parameter = animated_parameter(description, scene, at);
    if (!keyframes || keyframes->empty())
        at.fail("expected { keys = [[frame, value], ...] }, found no keyframes");
    Track track;
    track.key = parameter.spec.key;
    read_settings(*table, parameter.spec, track, at);
    for (const toml::node& element : *keyframes)
        track.keyframes.push_back(read_keyframe(element, parameter, track, at));
    check_order(track, at);
    return track;
}

std::vector<Track> read_tracks(const toml::table& table, Scene& scene, const std::string& file) {
    struct Found {
        toml::source_position position;
        Track track;
    };
    std::vector<Found> found;
    for (const auto& [key, node] : table) {
        const std::string place = place_of(file, key.source());
        found.push_back({key.source().begin, read_track(std::string(key.str()), node, scene, place)});
        for (std::size_t i = 0; i + 1 < found.size(); ++i)
            if (found[i].track.key == found.back().track.key)
                throw InputError(
                    fmt::format("{}: {}: expected one track, found a second", place, found.back().track.key));
    }
    std::ranges::sort(found, {}, &Found::position);
    std::vector<Track> tracks;
    for (Found& one : found) tracks.push_back(std::move(one.track));
    return tracks;
}

std::string track_to_toml(const Track& track, const ParameterSpec& spec) {
    std::string list;
    for (const auto& keyframe : track.keyframes) {
        list += fmt::format("{}[{}, {}", list.empty() ? "" : ", ", short_number(keyframe.frame),
                            to_toml(from_numbers(spec, keyframe.value)));
        const std::string handles = handles_to_toml(keyframe);
        if (keyframe.interpolation != track.interpolation || !handles.empty())
            list += fmt::format(", \"{}\"", name_of(keyframe.interpolation));
        list += handles.empty() ? "]" : ", " + handles + "]";
    }
    std::string text = "{ keys = [" + list + "]";
    if (track.interpolation != Interpolation::linear)
        text += fmt::format(", interpolation = \"{}\"", name_of(track.interpolation));
    if (track.ends != Ends::ease) text += fmt::format(", ends = \"{}\"", name_of(track.ends));
    if (track.constant_speed) text += ", constant_speed = true";
    return text + " }";
}

}  // namespace astrosplat
