#include "batch_plan.h"

#include <fmt/format.h>

#include "bodies/bodies.h"
#include "core/error.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/text.h"
#include "exit.h"
#include "output/format.h"
#include "output/metadata.h"
#include "output/write.h"
#include "pipeline.h"
#include "scene/animate.h"
#include "scene/camera_file.h"
#include "scene/check.h"
#include "scene/frames.h"
#include "scene/layer_setup.h"
#include "scene/load.h"
#include "sets/load_source.h"

namespace astrosplat {
namespace {

/// Exactly `count` whole numbers between separators, or none.
std::vector<std::int64_t> whole_numbers(const std::string& text, char separator, std::size_t count) {
    std::vector<std::int64_t> numbers;
    for (const std::string& part : split(text, separator)) {
        const std::optional<std::int64_t> number = parse_int64(part);
        if (!number) return {};
        numbers.push_back(*number);
    }
    if (numbers.size() != count) numbers.clear();
    return numbers;
}

void apply_resolution(OutputParams& output, const std::string& text) {
    const char* expected = "a size such as 1920x1080, or a percentage such as 50%";
    if (!text.empty() && text.back() == '%') {
        const std::optional<double> percent = parse_double(text.substr(0, text.size() - 1));
        if (!percent || !(*percent > 0.0 && *percent <= 1000.0))
            bad_input("--resolution", "", expected, "'" + text + "'");
        const auto scaled = [&](std::int64_t side) {
            return std::max<std::int64_t>(
                1, static_cast<std::int64_t>(static_cast<double>(side) * *percent / 100.0 + 0.5));
        };
        output.width = scaled(output.width);
        output.height = scaled(output.height);
        return;
    }
    const std::vector<std::int64_t> size = whole_numbers(text, 'x', 2);
    if (size.empty() || std::min(size[0], size[1]) < 1 || std::max(size[0], size[1]) > 65536) {
        bad_input("--resolution", "", expected, "'" + text + "'");
    }
    if (is_dome(output) && size[0] != size[1])  // drafts may be smaller, but nothing else than square
        bad_input("--resolution", "", "a square for the preset dome", "'" + text + "'");
    output.width = size[0];
    output.height = size[1];
}

/// Shows the layers named and hides the others, whatever the scene says about them.
void apply_layers(Scene& scene, const std::string& text) {
    const std::vector<std::string> wanted = split(text, ',');
    std::vector<std::string> known;
    for (const LayerParams& layer : scene.layers) known.push_back(layer.name);
    for (const std::string& name : wanted) {
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            bad_input("--layers", "", fmt::format("layers of the scene ({})", fmt::join(known, ", ")),
                      "'" + name + "'");
        }
    }
    for (LayerParams& layer : scene.layers) {
        const ParameterKey track_key = layer_key(layer.name) / "visible";
        const auto is_track = [&](const Track& track) { return track.key == track_key; };
        const bool shown = std::find(wanted.begin(), wanted.end(), layer.name) != wanted.end();
        layer.visible = shown;
        if (!shown) std::erase_if(scene.animation, is_track);
    }
    if (!scene.camera.position && scene.camera.file.empty()) {
        log_info("the scene gives no camera position: the camera frames only the layers of --layers");
    }
}

Region parse_region(const std::string& text, const OutputParams& output) {
    const std::vector<std::int64_t> r = whole_numbers(text, ',', 4);
    if (r.empty() || r[0] < 0 || r[1] < 0 || r[2] < 1 || r[3] < 1 || r[0] > output.width - r[2] ||
        r[1] > output.height - r[3]) {
        bad_input("--region", "",
                  fmt::format("X,Y,W,H inside the frame of {}x{} px", output.width, output.height),
                  "'" + text + "'");
    }
    return {r[0], r[1], r[2], r[3]};
}

Scene batch_scene(const CommandOptions& options) {
    auto [scene, places] = load_placed(options.input, assignments_of(options));
    if (options.frames) scene.output.frames = *options.frames;
    if (options.output) scene.output.path = options.output->string();
    if (options.resolution) apply_resolution(scene.output, *options.resolution);
    refresh_camera_file(scene, "");  // a lens shift depends on the frame's shape
    if (options.layers) apply_layers(scene, *options.layers);
    check_renderable(scene, places);
    check_output(scene.output, places);
    return std::move(scene);
}

/// A missing input is to be reported before the first folder is made.
void check_inputs(Scene scene) {
    std::erase_if(scene.layers, [&](const LayerParams& layer) { return !ever_visible(scene, layer); });
    std::vector<fs::path> files = picture_files(scene);
    for (const LayerParams& layer : scene.layers)
        for (const fs::path& file : named_files(layer.source)) files.push_back(file);
    for (const fs::path& file : files) {
        std::error_code ignored;
        if (!file.empty() && !fs::exists(file, ignored))
            bad_input(file.string(), "", "an input file", "nothing of that name");
    }
}

std::vector<std::int64_t> frame_numbers(const BatchPlan& plan, bool from_command_line) {
    const std::string place = from_command_line ? "--frames" : plan.scene.file.string() + ": output.frames";
    std::vector<std::int64_t> frames = parse_frames(plan.scene.output.frames, place);
    if (frames.size() > 1 && !plan.output.is_numbered()) {
        bad_input(
            plan.output.text(), "",
            fmt::format("a frame number such as #### in the name, as there are {} frames", frames.size()),
            "none");
    }
    return frames;
}

/// Decides what becomes of files that lie where frames go (DESIGN 8).
void decide(std::vector<FramePlan>& frames, const CommandOptions& options) {
    for (const FramePlan& frame : frames) refuse_other_than_file(frame.file);
    if (options.overwrite && !options.resume) return;
    std::vector<const FramePlan*> in_the_way;
    for (FramePlan& frame : frames) {
        std::error_code ignored;
        frame.existing = Existing::keep;
        if (!options.resume) {
            if (fs::exists(fs::symlink_status(frame.file, ignored))) in_the_way.push_back(&frame);
            continue;
        }
        const Found found = found_at(frame);
        frame.render = found != Found::same;
        if (found == Found::damaged) log_info(frame.file.string() + ": damaged, is rendered again");
        if (found == Found::other && !options.overwrite) in_the_way.push_back(&frame);
        if (found != Found::nothing) frame.existing = Existing::replace;
    }
    if (in_the_way.empty()) return;
    const std::string more = in_the_way.size() > 1 ? fmt::format(" and {} more", in_the_way.size() - 1) : "";
    const std::string file = in_the_way.front()->file.string() + more;
    throw InputError(options.resume
                         ? file + ": holds a frame of other settings; --resume --overwrite replaces it"
                         : file + ": exists already; use --resume to keep it or --overwrite to replace it");
}

}  // namespace

std::int64_t parse_memory(const std::string& text) {
    constexpr double least = 1e-9, most = 1048575.0;  // GiB
    return static_cast<std::int64_t>(
        option_number("--memory", text, "a size in GiB, such as 4", least, most) * 1073741824.0);
}

void limit_bodies(LayerParams& layer, std::int64_t bytes, const SetCache& cache) {
    constexpr std::int64_t others_bytes = 189'000'000;  // never another number: pixels depend on it
    bytes = std::max<std::int64_t>(bytes - others_bytes, 1);
    SourceParams& source = layer.source;
    if (source.kind != SourceKind::mesh || source.structure.kind == StructureKind::columns) return;
    std::vector<TexturedMesh> meshes =
        load_meshes(cache, source, stoppable(), most_texels_read(source, bytes));
    if (source.structure.detail == 0) enlarge_small_pictures(meshes, layer.name);
    const std::int64_t largest = largest_picture(meshes);
    reduce_pictures(meshes, source.structure, {bytes, 0}, layer.name);
    const std::int64_t fitting = largest_picture(meshes);
    if (fitting < largest) source.structure.most_texels = fitting;
}

Found found_at(const FramePlan& plan) {
    std::error_code ignored;
    if (!fs::exists(fs::symlink_status(plan.file, ignored))) return Found::nothing;
    if (fs::exists(plan.file, ignored) && !fs::is_regular_file(plan.file, ignored)) return Found::other;
    if (!frame_is_whole(plan.file)) return Found::damaged;
    return read_frame_header(plan.file).frame_hash == plan.hash ? Found::same : Found::other;
}

std::int64_t count_to_render(const BatchPlan& plan) {
    std::int64_t count = 0;
    for (const FramePlan& frame : plan.frames) count += frame.render;
    return count;
}

BatchPlan plan_scene(const CommandOptions& options) {
    BatchPlan plan;
    plan.scene = batch_scene(options);
    const fs::path scene_folder = fs::absolute(plan.scene.file).parent_path();
    plan.output = output_pattern(options.output ? fs::current_path() : scene_folder, plan.scene.output.path);
    plan.scene.output.path = plan.output.text();
    if (options.region) plan.region = parse_region(*options.region, plan.scene.output);
    if (options.memory_gib) plan.memory_limit_bytes = parse_memory(*options.memory_gib);
    plan.cache = options.cache;
    plan.resume = options.resume;
    check_inputs(plan.scene);
    if (plan.memory_limit_bytes > 0)
        for (LayerParams& layer : plan.scene.layers)
            if (ever_visible(plan.scene, layer)) limit_bodies(layer, plan.memory_limit_bytes, plan.cache);
    plan.hasher = FrameHasher(plan.region);
    return plan;
}

BatchPlan plan_frames(const CommandOptions& options) {
    BatchPlan plan = plan_scene(options);
    const std::vector<Eye> eyes = eyes_of(plan.output, plan.scene.camera);
    const std::vector<std::int64_t> numbers = frame_numbers(plan, options.frames.has_value());
    if (const std::string missed = missed_camera_frames(plan.scene, numbers); !missed.empty())
        log_warning(missed);
    for (const std::int64_t frame : numbers)
        for (const Eye eye : eyes) {
            const FrameScene now = frame_scene(plan.scene, static_cast<double>(frame), eye);
            plan.frames.push_back({frame, eye, plan.output.resolve(frame, eye), plan.hasher.frame_hash(now)});
        }
    return plan;
}

BatchPlan plan_batch(const CommandOptions& options) {
    BatchPlan plan = plan_frames(options);
    decide(plan.frames, options);
    return plan;
}

}  // namespace astrosplat
