#include "cross/rendering.h"

#include "camera/camera.h"
#include "core/parallel.h"
#include "cross/inputs.h"
#include "frame/frame_hash.h"
#include "frame/output_pattern.h"
#include "gl/card.h"
#include "output/write.h"
#include "pipeline.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"
#include "sets/kept.h"

namespace astrosplat::test {
namespace {

/// The pool and the instruction set as a machine has them, while it lives.
class InUse {
  public:
    explicit InUse(const Machine& machine) {
        set_thread_count(machine.threads);
        set_vector_target(machine.target);
    }
    ~InUse() {
        set_thread_count(0);
        set_vector_target("best");
    }
    InUse(const InUse&) = delete;
    InUse& operator=(const InUse&) = delete;
};

std::vector<std::string> native_layers(const Scene& scene) {
    std::vector<std::string> names;
    for (const LayerParams& layer : scene.layers)
        if (layer.source.kind == SourceKind::splats && layer.source.file.extension() == ".splats")
            names.push_back(layer.name);
    return names;
}

/// The card that draws for it; null: the processor does.
RenderDevice* card_for(Device device) {
    const auto open = [](DeviceChoice choice) -> std::unique_ptr<OwnCard> {
        try {
            return open_card({choice});
        } catch (const NoContext&) {
            return nullptr;
        }
    };
    if (device == Device::cpu) return nullptr;
    static const bool found = open(DeviceChoice::automatic) != nullptr;
    static const std::unique_ptr<OwnCard> asked = open(DeviceChoice::gpu);  // whose context stays current
    return asked && (device == Device::gpu || found) ? &asked->card() : nullptr;
}

RenderSettings settings_of(const Scene& scene, Extra extra, const Machine& machine) {
    RenderSettings settings = render_settings(scene.output);
    settings.device = card_for(machine.device);
    settings.tile_px = machine.tile_px;
    if (extra == Extra::all)
        settings.aov_depth = settings.aov_coverage = settings.aov_count = settings.aov_layers = true;
    return settings;
}

Shot rendered_by(Pipeline& pipeline, double number, Eye eye, Extra extra, const Machine& machine) {
    const FrameScene frame = pipeline.frame_scene(number, eye);
    return {pipeline.frame(frame, settings_of(frame.scene, extra, machine)), pipeline.layer_names(frame), {}};
}

}  // namespace

Machine machine_of(const Crossing& c) {
    const std::vector<std::string> targets = vector_targets();  // the best first
    Machine machine;
    machine.threads = c.threads == Answer::yes ? 3 : 1;
    machine.tile_px = c.small_tiles == Answer::yes ? 16 : 0;
    if (c.target == Target::least) machine.target = targets.back();
    if (c.target == Target::between) machine.target = targets[targets.size() / 2];
    machine.streamed = c.streamed == Answer::yes;
    machine.device = c.device;
    return machine;
}

std::string device_word(const Crossing& c) {
    const bool draws = !is_onto_sphere(c.projection) && card_for(Device::gpu);
    return std::string(name_of(c.device == Device::gpu && !draws ? Device::automatic : c.device));
}

Shot shot_of(const Scene& scene, double frame, Eye eye, Extra extra, const Machine& on) {
    const InUse in_use(on);
    Pipeline pipeline(scene, {}, shared_sets(),
                      on.streamed ? native_layers(scene) : std::vector<std::string>());
    return rendered_by(pipeline, frame, eye, extra, on);
}

Window::Window(const Scene& scene) : pipeline_(std::make_unique<Pipeline>()) {
    for (const LayerParams& layer : scene.layers)
        sets_.push_back(std::make_shared<const SplatSet>(
            load_source(shared_sets(), source_of(scene, layer), layer.name).set));
}

Window::~Window() = default;

Shot Window::shot_of(const Scene& scene, double frame, Eye eye, Extra extra) {
    pipeline_->set_scene(scene, sets_);
    return rendered_by(*pipeline_, frame, eye, extra, {});
}

std::vector<Shot> samples_of(const Scene& scene, double number, Eye eye) {
    const CameraParams camera = scene_at(scene, number).camera;
    const int count = is_blurred(camera) ? int(scene.output.samples) : 1;
    Scene sharp = scene;
    sharp.camera.shutter = sharp.camera.f_number = 0.0;
    Pipeline pipeline(sharp, {}, shared_sets());
    static RenderCache tables;  // of footprints, which take longer to make than these frames
    std::optional<Environment> sky;
    if (has_environment(scene.environment))
        sky = load_environment(scene.environment, {}, kept_skies(shared_sets()));
    std::vector<Shot> samples;
    for (int i = 0; i < count; ++i) {
        const CameraSample sample = camera_sample(camera, i, count);
        const FrameScene frame = pipeline.frame_scene(count > 1 ? number + sample.frames : number, eye);
        RenderSettings settings = settings_of(frame.scene, Extra::all, {});
        settings.opacity = true;
        const std::vector<RenderLayer> layers = pipeline.shaded_layers(frame);
        CameraParams lens = frame.scene.camera;
        lens.f_number = count > 1 ? camera.f_number : 0.0;
        const Camera seen =
            through_lens(pipeline.camera(frame, settings), lens, sample.lens, double(settings.width));
        const EnvironmentParams& environment = frame.scene.environment;
        if (sky) set_environment_params(*sky, environment);
        const auto rendered = [&](const Environment* behind) {
            return render(layers, seen, behind, settings, {}, &tables);
        };
        samples.push_back({rendered(sky && environment.visible ? &*sky : nullptr),
                           pipeline.layer_names(frame),
                           {rendered(nullptr)}});
    }
    return samples;
}

std::string hash_of(const Scene& scene, std::int64_t frame, Eye eye) {
    return FrameHasher().frame_hash(frame_scene(scene, double(frame), eye));
}

fs::path batch_file(const Scene& scene, std::int64_t frame, Eye eye) {
    return output_pattern(scene.file.parent_path(), scene.output.path).resolve(frame, eye);
}

fs::path file_of_output(const fs::path& working_directory, const std::string& output, std::int64_t frame,
                        Eye eye) {
    return output_pattern(working_directory, output).resolve(frame, eye);
}

void write_shot(const Scene& scene, const Shot& shot, std::int64_t frame, Eye eye, const fs::path& file) {
    FrameMetadata metadata;
    metadata.frame = frame;
    metadata.eye = eye;
    metadata.frame_hash = hash_of(scene, frame, eye);
    metadata.hashed_text = FrameHasher().canonical_text(frame_scene(scene, double(frame), eye));
    metadata.pixel_hash = pixel_hash(shot.frame.beauty);
    const OutputParams& output = scene.output;
    write_frame({file, output, output.width, output.height, {}, shot.layers}, shot.frame, metadata);
}

}  // namespace astrosplat::test
