#include "stats.h"

#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/vector_target.h"

namespace astrosplat {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const FrameFigures& frame) {
    return {{"frame", frame.frame},
            {"file", frame.file.string()},
            {"seconds", frame.seconds},
            {"render_seconds", frame.render_seconds},
            {"write_seconds", frame.write_seconds},
            {"splats_in", frame.splats_in},
            {"splats_drawn", frame.splats_drawn},
            {"sha256", frame.sha256}};
}

Json to_json(const LayerStatistics& layer) {
    return {{"name", layer.name},
            {"test_positions", layer.test_positions},
            {"kept", layer.kept},
            {"zero_alpha", layer.zero_alpha},
            {"drawn", layer.drawn},
            {"generate_seconds", layer.generate_seconds},
            {"look_seconds", layer.look_seconds},
            {"cached", layer.cached},
            {"geometry_cached", layer.geometry_cached}};
}

Json to_json(const FailedFrame& frame) {
    return {{"frame", frame.frame}, {"file", frame.file.string()}, {"error", frame.error}};
}

template <class T>
Json to_json(const std::vector<T>& items) {
    Json list = Json::array();
    for (const T& item : items) list.push_back(to_json(item));
    return list;
}

}  // namespace

void write_stats(const std::filesystem::path& file, const RunFigures& figures) {
    const Json json = {{"frames", to_json(figures.frames)},        {"failed", to_json(figures.failed)},
                       {"layers", to_json(figures.layers)},        {"seconds", figures.seconds},
                       {"peak_memory_bytes", peak_memory_bytes()}, {"threads", thread_count()},
                       {"vector_target", vector_target()},         {"version", ASTROSPLAT_VERSION}};
    write_file_atomically(file, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace astrosplat
