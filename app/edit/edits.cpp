// Every value is checked by setting it to itself: the description knows its range. Tracks stay sorted by
// frame; a parameter without a track has no keyframes.
#include "edit/edits.h"

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "scene/animate.h"
#include "scene/camera_file.h"
#include "scene/check.h"
#include "scene/describe.h"
#include "scene/entries.h"
#include "scene/frames.h"
#include "scene/load.h"

namespace astrosplat {
namespace {

void check_names(const Scene& scene, const std::string& name) {
    std::set<std::string> names;
    for (const LayerParams& layer : scene.layers) {
        check_layer_name(layer.name, name);
        if (!names.insert(layer.name).second)
            throw InputError(
                fmt::format("{}: layer.name: expected each name once, found '{}' twice", name, layer.name));
    }
}

/// Bytes that UTF-8 cannot have, such as file names of another encoding: a scene file cannot hold them.
bool is_utf8(const std::string& text) {
    try {
        return !nlohmann::json(text).dump().empty();
    } catch (const nlohmann::json::exception&) {
        return false;
    }
}

void check_text(const Value& value, const std::string& key) {
    if (const std::string* text = value.text(); text && !is_utf8(*text))
        throw InputError(key + ": expected text in UTF-8, found another encoding");
    if (const Value::List* list = value.list())
        for (const Value& element : *list) check_text(element, key);
}

void set_checked(const Parameter& parameter, const Value& value) {
    naming(parameter.spec.key, [&] { parameter.set(value); });
}

void check_track(const Track& track, const Parameter& parameter) {
    const auto fail = [&](const char* message) {
        throw InputError(fmt::format("{}: {}", track.key, message));
    };
    if (parameter.spec.animation == Animation::no) fail("this parameter cannot be animated");
    if (track.keyframes.empty()) fail("expected at least one keyframe, found none");
    const Value value = parameter.get();
    for (std::size_t i = 0; i < track.keyframes.size(); ++i) {
        const auto& keyframe = track.keyframes[i];
        if (!std::isfinite(keyframe.frame)) fail("expected a finite frame number, found another");
        if (i > 0 && !(track.keyframes[i - 1].frame < keyframe.frame))
            fail("expected ascending frames, each once, found others");
        if (keyframe.value.size() != track.keyframes[0].value.size() || keyframe.value.empty())
            fail("expected as many numbers in every keyframe, found another number");
        for (const double x : keyframe.value)
            if (!std::isfinite(x)) fail("expected finite numbers in every keyframe, found another");
        set_checked(parameter, from_numbers(parameter.spec, keyframe.value));
    }
    parameter.set(value);
}

}  // namespace

void check_edited_scene(Scene& scene, const std::string& name) {
    check_names(scene, name);
    const Description description = describe(scene);
    std::erase_if(scene.animation,
                  [&](const Track& track) { return !find_parameter(description, track.key); });
    for (const Parameter& parameter : description.parameters) {
        const Value value = parameter.get();
        check_text(value, parameter.spec.key);
        set_checked(parameter, value);
    }
    for (const Track& track : scene.animation) check_track(track, *find_parameter(description, track.key));
    check_scene(scene, name, {});
    refresh_camera_file(scene, name);
}

void apply_output_preset(Scene& scene) {
    if (scene.output.preset.empty()) return;
    const std::string head = "astrosplat = 1\n";
    const std::string text = fmt::format("[output]\npreset = {}\n", to_toml(scene.output.preset.string()));
    Scene blank = parse_unchecked(head, scene.file), loaded = parse_unchecked(head + text, scene.file);
    const Description standard = describe(blank), wanted = describe(scene);
    for (const Parameter& parameter : describe(loaded).parameters) {
        const ParameterKey& key = parameter.spec.key;
        const Parameter *before = find_parameter(standard, key), *own = find_parameter(wanted, key);
        if (before && own && key != "output.preset" && !(before->get() == parameter.get()))
            own->set(parameter.get());
    }
}

void keep_dome_square(Scene& scene, const Scene& before) {
    OutputParams& output = scene.output;
    if (!is_dome(output)) return;
    const bool width_changed = output.width != before.output.width,
               height_changed = output.height != before.output.height;
    if (width_changed && !height_changed) output.height = output.width;
    if (height_changed && !width_changed) output.width = output.height;
}

namespace {

/// Of all keyframes; `otherwise` where there is none.
double last_keyframe(const Scene& scene, double otherwise) {
    double last = otherwise;
    for (const Track& track : scene.animation)
        for (const auto& keyframe : track.keyframes) last = std::max(last, keyframe.frame);
    return last;
}

}  // namespace

double film_frames(const OutputParams& output) {
    constexpr double seconds = 10.0;
    return std::fmax(1.0, std::floor(seconds * output.fps + 0.5));
}

void film_still(const Scene& before, Scene& after) {
    if (before.output.frames != after.output.frames) return;
    const std::vector<std::int64_t> frames = parse_frames(after.output.frames, "output.frames");
    const auto first = static_cast<double>(frames.front());
    if (frames.size() != 1 || last_keyframe(before, first) > first) return;
    const double last = last_keyframe(after, first);
    if (last > first)
        after.output.frames = fmt::format(
            "{}-{}", frames.front(), std::llround(std::max(first + film_frames(after.output) - 1.0, last)));
}

FrameRange frame_range(const OutputParams& output) {
    try {
        const std::vector<std::int64_t> frames = parse_frames(output.frames, "output.frames");
        if (!frames.empty()) return {static_cast<double>(frames.front()), static_cast<double>(frames.back())};
    } catch (const InputError&) {
        // Said where it is typed; the timeline shows one frame meanwhile.
    }
    return {};
}

FrameRange shown_range(const Scene& scene) {
    FrameRange range = frame_range(scene.output);
    if (range.first == range.last) range.last += film_frames(scene.output) - 1.0;
    return range;
}

double rounded_to_step(double value, double step) {
    if (!(step > 0.0)) return value;
    const int digits = static_cast<int>(std::floor(std::log10(step)));
    // Dividing by a whole power of ten gives the double nearest to the short decimal; multiplying by 0.001
    // does not.
    const double power = std::pow(10.0, std::abs(digits));
    const double rounded = digits < 0 ? std::round(value * power) / power : std::round(value / power) * power;
    return rounded + 0.0;  // never -0
}

namespace {

using Numbers = std::vector<double>;
using TrackKeyframe = Keyframe<Numbers>;

/// Null: none.
TrackKeyframe* keyframe_at(Track* track, double frame) {
    if (!track) return nullptr;
    const auto found = std::ranges::find(track->keyframes, frame, &TrackKeyframe::frame);
    return found == track->keyframes.end() ? nullptr : &*found;
}

TrackKeyframe* keyframe_of(Scene& scene, const std::string& key, double frame) {
    return keyframe_at(find_track(scene, key), frame);
}

/// Puts a keyframe in its place, instead of one that is there.
void insert_keyframe(Track& track, TrackKeyframe keyframe) {
    std::erase_if(track.keyframes, [&](const TrackKeyframe& old) { return old.frame == keyframe.frame; });
    const auto after = std::ranges::upper_bound(track.keyframes, keyframe.frame, {}, &TrackKeyframe::frame);
    track.keyframes.insert(after, std::move(keyframe));
}

/// Of a new keyframe: within a Bezier segment it is Bezier, too.
Interpolation way_at(const Track& track, double frame) {
    const auto after = std::ranges::upper_bound(track.keyframes, frame, {}, &TrackKeyframe::frame);
    const bool within = after != track.keyframes.begin() && after != track.keyframes.end();
    const bool bends = within && (after - 1)->interpolation == Interpolation::bezier;
    return bends ? Interpolation::bezier : track.interpolation;
}

/// The numbers of a value that fits the parameter; sets it in passing.
Numbers numbers_for(const Parameter& parameter, const Value& value) {
    return naming(parameter.spec.key, [&] {
        parameter.set(value);
        Numbers numbers = to_numbers(parameter.spec, value);
        const bool nothing = numbers.empty() || (value.text() && value == parameter.spec.nothing);
        const bool zero = std::ranges::all_of(numbers, [](double x) { return x == 0.0; });
        if (nothing || (zero && parameter.spec.type == ParameterType::rotation))
            throw ValueError(
                fmt::format("expected {}, found {}", expectation(parameter.spec), nothing ? "none" : "0"));
        return numbers;
    });
}

/// A new track moves smoothly, as people expect of a camera or a slider; values that step have
/// no way between.
Track new_track(const ParameterSpec& spec) {
    Track track;
    track.key = spec.key;
    if (spec.animation == Animation::yes) track.interpolation = Interpolation::smooth;
    return track;
}

}  // namespace

const Track* find_track(const Scene& scene, const std::string& key) {
    const auto found = std::ranges::find_if(scene.animation, [&](const Track& t) { return t.key == key; });
    return found == scene.animation.end() ? nullptr : &*found;
}

Track* find_track(Scene& scene, const std::string& key) {
    return const_cast<Track*>(find_track(std::as_const(scene), key));
}

bool is_animated(const Scene& scene, const std::string& key) { return find_track(scene, key) != nullptr; }

bool has_keyframe_at(const Scene& scene, const std::string& key, double frame) {
    const Track* const track = find_track(scene, key);
    return track && std::ranges::count(track->keyframes, frame, &TrackKeyframe::frame) > 0;
}

void set_keyframe(Scene& scene, const std::string& key, double frame, const Value& value) {
    if (!std::isfinite(frame)) throw InputError(key + ": expected a finite frame number, found another");
    Scene scratch = scene;  // values are checked by setting them
    const Description description = describe(scratch);
    const Parameter* parameter = find_parameter(description, key);
    if (!parameter) throw InputError(key + ": expected a parameter of the scene, found none of that name");
    if (parameter->spec.animation == Animation::no)
        throw InputError(parameter->spec.key.text() + ": this parameter cannot be animated");
    Numbers numbers = numbers_for(*parameter, value);
    Track* track = find_track(scene, parameter->spec.key);
    if (!track) {
        scene.animation.push_back(new_track(parameter->spec));
        track = &scene.animation.back();
    }
    const bool alone =
        track->keyframes.empty() || (track->keyframes.size() == 1 && track->keyframes[0].frame == frame);
    if (!alone && track->keyframes[0].value.size() != numbers.size())
        throw InputError(parameter->spec.key.text() +
                         ": expected as many points as in the other keyframes, found " + "another number");
    if (TrackKeyframe* const old = keyframe_at(track, frame))
        old->value = std::move(numbers);
    else
        insert_keyframe(*track, {frame, numbers, way_at(*track, frame)});
}

void remove_keyframe(Scene& scene, const std::string& key, double frame) {
    const TrackKeyframe* const found = keyframe_of(scene, key, frame);
    if (!found) return;
    Track& track = *find_track(scene, key);
    if (track.keyframes.size() > 1) {
        std::erase_if(track.keyframes, [&](const TrackKeyframe& k) { return k.frame == frame; });
        return;
    }
    const Description description = describe(scene);
    if (const Parameter* parameter = find_parameter(description, key))
        parameter->set(from_numbers(parameter->spec, found->value));
    remove_track(scene, key);
}

void remove_track(Scene& scene, const std::string& key) {
    std::erase_if(scene.animation, [&](const Track& track) { return track.key == key; });
}

void move_keyframe(Scene& scene, const std::string& key, double from, double to) {
    if (from == to || !std::isfinite(to) || !has_keyframe_at(scene, key, from)) return;
    copy_keyframe(scene, key, from, to);
    std::erase_if(find_track(scene, key)->keyframes, [&](const TrackKeyframe& k) { return k.frame == from; });
}

void copy_keyframe(Scene& scene, const std::string& key, double from, double to) {
    const TrackKeyframe* const found = keyframe_of(scene, key, from);
    if (!found || !std::isfinite(to)) return;
    TrackKeyframe copy = *found;
    copy.frame = to;
    insert_keyframe(*find_track(scene, key), std::move(copy));
}

void set_interpolation(Scene& scene, const std::string& key, double frame, Interpolation interpolation) {
    if (TrackKeyframe* const found = keyframe_of(scene, key, frame)) found->interpolation = interpolation;
}

void set_ends(Scene& scene, const std::string& key, Ends ends) {
    if (Track* track = find_track(scene, key)) track->ends = ends;
}

std::vector<double> frames_with_keyframes(const Scene& scene) {
    std::vector<double> frames;
    for (const Track& track : scene.animation)
        for (const TrackKeyframe& keyframe : track.keyframes) frames.push_back(keyframe.frame);
    std::sort(frames.begin(), frames.end());
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    return frames;
}

double frame_of_next_keyframe(const Scene& scene, double frame) {
    const std::vector<double> frames = frames_with_keyframes(scene);
    const auto next = std::upper_bound(frames.begin(), frames.end(), frame);
    return next == frames.end() ? frame : *next;
}

double frame_of_previous_keyframe(const Scene& scene, double frame) {
    const std::vector<double> frames = frames_with_keyframes(scene);
    const auto here = std::lower_bound(frames.begin(), frames.end(), frame);
    return here == frames.begin() ? frame : *(here - 1);
}

namespace {

constexpr double least_frames = 1e-3;  // of a handle that another one turns with

/// The handle at `side` of a keyframe as it acts; of no segment: with no frames.
Handle<Numbers> acting(Scene& scene, const std::string& key, double frame, HandleSide side) {
    const Track& track = *find_track(scene, key);
    const Description description = describe(scene);
    const Parameter* parameter = find_parameter(description, key);
    const TrackKeyframe* const found = keyframe_of(scene, key, frame);
    if (!parameter || !found) return {};
    const TrackHandles handles =
        handles_of(track, parameter->spec)[static_cast<std::size_t>(found - track.keyframes.data())];
    return side == HandleSide::in ? handles.in : handles.out;
}

/// Free, where it acts now; of no segment: automatic.
Handle<Numbers> freed(Scene& scene, const std::string& key, double frame, HandleSide side) {
    Handle<Numbers> handle = acting(scene, key, frame, side);
    if (handle.frames == 0.0 && handle.kind != HandleKind::free) return {};
    handle.kind = HandleKind::free;
    return handle;
}

/// Turned to the direction of `leader`, at the frames it has.
void follow(Handle<Numbers>& handle, const Handle<Numbers>& leader) {
    if (handle.kind != HandleKind::free || std::fabs(leader.frames) < least_frames) return;
    handle.value = leader.value;
    for (double& number : handle.value) number *= handle.frames / leader.frames;
}

Handle<Numbers>& handle_at(TrackKeyframe& keyframe, HandleSide side) {
    return side == HandleSide::in ? keyframe.in : keyframe.out;
}

HandleSide other(HandleSide side) { return side == HandleSide::in ? HandleSide::out : HandleSide::in; }

}  // namespace

bool has_handle(const Track& track, std::size_t i, HandleSide side) {
    const bool before = side == HandleSide::in;
    if (before ? i == 0 : i + 1 >= track.keyframes.size()) return false;
    return track.keyframes[before ? i - 1 : i].interpolation == Interpolation::bezier;
}

void set_handle_kind(Scene& scene, const std::string& key, double frame, HandleKind kind) {
    TrackKeyframe* const keyframe = keyframe_of(scene, key, frame);
    if (!keyframe) return;
    for (const HandleSide side : {HandleSide::in, HandleSide::out})
        handle_at(*keyframe, side) =
            kind == HandleKind::free ? freed(scene, key, frame, side) : Handle<Numbers>{kind, 0.0, {}};
}

void ease(Scene& scene, const std::string& key, double frame, HandleSide side) {
    TrackKeyframe* const keyframe = keyframe_of(scene, key, frame);
    if (!keyframe) return;
    std::vector<TrackKeyframe>& all = find_track(scene, key)->keyframes;
    const bool before = side == HandleSide::in;
    if (keyframe == (before ? &all.front() : &all.back())) return;
    (before ? keyframe - 1 : keyframe)->interpolation = Interpolation::bezier;
    handle_at(*keyframe, side) = {HandleKind::flat, 0.0, {}};
    keyframe->broken = handle_at(*keyframe, other(side)).kind != HandleKind::flat;
}

void set_broken(Scene& scene, const std::string& key, double frame, bool broken) {
    TrackKeyframe* const keyframe = keyframe_of(scene, key, frame);
    if (!keyframe) return;
    keyframe->broken = broken;
    if (!broken) follow(keyframe->in, acting(scene, key, frame, HandleSide::out));
}

void set_handle(Scene& scene, const std::string& key, double frame, HandleSide side, double frames,
                const Numbers& value) {
    TrackKeyframe* const keyframe = keyframe_of(scene, key, frame);
    if (!keyframe) return;
    const Handle<Numbers> second = freed(scene, key, frame, other(side));
    const bool right_side = side == HandleSide::in ? frames < 0.0 : frames > 0.0;
    handle_at(*keyframe, side) = {HandleKind::free, right_side ? frames : 0.0, value};
    if (keyframe->broken) return;
    handle_at(*keyframe, other(side)) = second;
    follow(handle_at(*keyframe, other(side)), handle_at(*keyframe, side));
}

}  // namespace astrosplat
