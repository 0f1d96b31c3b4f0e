#include "scene/track_handles.h"

#include <cmath>

#include "scene/parameter.h"
#include "scene/suggest.h"
#include "scene/value.h"

namespace astrosplat {
namespace {

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
                        text ? "'" + text->get() + "'" : kind_of(node)));
}

std::string handle_to_toml(const Handle<std::vector<double>>& handle) {
    if (handle.kind == HandleKind::automatic) return "\"auto\"";
    if (handle.kind == HandleKind::flat) return "\"flat\"";
    Value::List numbers(handle.value.begin(), handle.value.end());
    return fmt::format("[{}, {}]", short_number(handle.frames),
                       to_toml(numbers.size() == 1 ? numbers[0] : Value(std::move(numbers))));
}

}  // namespace

void read_handles(const toml::node& node, Keyframe<std::vector<double>>& keyframe, const TrackPlace& at) {
    const std::size_t numbers = keyframe.value.size();
    const toml::table* table = node.as_table();
    if (!table) {
        const auto* text = node.as_string();
        if (!text || text->get() != "flat")
            at.fail(
                fmt::format("expected handles \"flat\" or {{ in = [frames, value], out = ... }}, found {}",
                            text ? "'" + text->get() + "'" : kind_of(node)));
        keyframe.in.kind = keyframe.out.kind = HandleKind::flat;
        return;
    }
    for (const auto& [name, part] : *table) {
        if (name == "in")
            keyframe.in = read_handle(part, numbers, true, at);
        else if (name == "out")
            keyframe.out = read_handle(part, numbers, false, at);
        else if (name == "broken" && part.is_boolean())
            keyframe.broken = part.as_boolean()->get();
        else if (name == "broken")
            at.fail(fmt::format("broken: expected true or false, found {}", kind_of(part)));
        else
            at.fail(fmt::format("unknown key '{}' of a keyframe{}", name.str(),
                                did_you_mean(std::string(name.str()), handle_settings)));
    }
}

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

}  // namespace astrosplat
