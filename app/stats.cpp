#include "stats.h"

#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/vector_target.h"

namespace astrosplat {
namespace {

using Json = nlohmann::ordered_json;

/// A number, a text or a truth as JSON. Lists and objects are not made of Json: its destructor takes memory
/// for them, and ends the program where there is none.
template <class T>
std::string json_text(const T& value) {
    return Json(value).dump(-1, ' ', false, Json::error_handler_t::replace);
}
std::string json_text(const std::filesystem::path& file) { return json_text(file.string()); }

using Members = std::vector<std::pair<std::string, std::string>>;  // name and JSON

std::string object_text(const Members& members, const std::string& indent = "      ") {
    std::string text = "{";
    for (const auto& [name, value] : members)
        text += (text.size() > 1 ? ",\n" : "\n") + indent + json_text(name) + ": " + value;
    return text + "\n" + indent.substr(2) + "}";
}

std::string object_of(const FrameFigures& frame) {
    return object_text({{"frame", json_text(frame.frame)},
                        {"file", json_text(frame.file)},
                        {"seconds", json_text(frame.seconds)},
                        {"render_seconds", json_text(frame.render_seconds)},
                        {"write_seconds", json_text(frame.write_seconds)},
                        {"splats_in", json_text(frame.splats_in)},
                        {"splats_drawn", json_text(frame.splats_drawn)},
                        {"sha256", json_text(frame.sha256)}});
}

std::string object_of(const LayerStatistics& layer) {
    return object_text({{"name", json_text(layer.name)},
                        {"test_positions", json_text(layer.test_positions)},
                        {"kept", json_text(layer.kept)},
                        {"zero_alpha", json_text(layer.zero_alpha)},
                        {"drawn", json_text(layer.drawn)},
                        {"generate_seconds", json_text(layer.generate_seconds)},
                        {"look_seconds", json_text(layer.look_seconds)},
                        {"cached", json_text(layer.cached)},
                        {"geometry_cached", json_text(layer.geometry_cached)}});
}

std::string object_of(const FailedFrame& frame) {
    return object_text({{"frame", json_text(frame.frame)},
                        {"file", json_text(frame.file)},
                        {"error", json_text(frame.error)}});
}

template <class T>
std::string list_of(const std::vector<T>& items) {
    std::string text = "[";
    for (const T& item : items) text += (text.size() > 1 ? ",\n    " : "\n    ") + object_of(item);
    return text + (items.empty() ? "]" : "\n  ]");
}

}  // namespace

void write_stats(const std::filesystem::path& file, const RunFigures& figures) {
    const Members members = {{"frames", list_of(figures.frames)},
                             {"failed", list_of(figures.failed)},
                             {"layers", list_of(figures.layers)},
                             {"seconds", json_text(figures.seconds)},
                             {"peak_memory_bytes", json_text(peak_memory_bytes())},
                             {"threads", json_text(thread_count())},
                             {"vector_target", json_text(vector_target())},
                             {"version", json_text(ASTROSPLAT_VERSION)}};
    write_file_atomically(file, object_text(members, "  ") + "\n");
}

}  // namespace astrosplat
