#include "pipeline.h"

#include <fmt/format.h>

#include <atomic>
#include <glm/matrix.hpp>

#include "camera/camera.h"
#include "core/buffer.h"
#include "core/text.h"
#include "look/apply.h"
#include "look/device.h"
#include "look/prepare.h"
#include "render/device.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"
#include "scene/source_metadata.h"
#include "source/origin.h"
#include "source/texture.h"
#include "streamed/streamed_set.h"

namespace astrosplat {
namespace {

using SetList = std::vector<std::shared_ptr<const SplatSet>>;  // one a layer; null: left out

constexpr double farthest_in_world = 1000.0 * largest_number;  // scene units, of splats in place

/// All that reaches apply_look besides the set: while it stays equal, the shaded splats stay.
struct ShadingInputs {
    Look look;
    LookInputs inputs;                  // without what is loaded for them
    std::optional<SeenFrom> seen_from;  // of colours that depend on it
    bool encoded = false;
    bool operator==(const ShadingInputs&) const = default;
};

/// Another number each time.
std::uint64_t new_stamp() {
    static std::atomic<std::uint64_t> stamps = 0;
    return ++stamps;
}

/// One layer between frames; the index is that of Scene::layers.
struct LayerState {
    std::shared_ptr<const SplatSet> set;    // null: not drawn
    std::shared_ptr<SplatSet> to_use_up;    // the same, where its splats are not read after the first shading
    std::unique_ptr<StreamedSet> streamed;  // in place of `set` and `shaded`
    Bounds box;                             // of the set, layer space
    fs::path thickness_file;
    Derived thickness_derived = Derived::none;
    Image thickness_map;
    std::optional<ShadingInputs> shaded_with;  // what `shaded` was made with
    ShadedSplats shaded;
    std::optional<ShadingInputs> shaded_there_with;  // the same of what a device has in its place
    DeviceSplats there;
    std::uint64_t set_stamp = new_stamp();
};

void count_set(const SplatSetFacts& facts, std::int64_t splats, LayerStatistics& counts) {
    counts.test_positions = facts.test_positions;
    counts.kept = splats;
    counts.zero_alpha = facts.zero_alpha;
}

/// Facts about the layer's set, which is there.
const SplatSetFacts& facts_of(const LayerState& layer) {
    return layer.streamed ? layer.streamed->file().facts() : *layer.set;
}

/// Where the layer is seen from.
SeenFrom seen_from(const Camera& camera, const RenderLayer& layer) {
    const glm::dmat3 layer_from_world = glm::transpose(layer.world_from_layer);
    if (camera.projection == Projection::orthographic) return {{}, layer_from_world * view_direction(camera)};
    return {layer_from_world * (camera.eye - layer.translate) / layer.scale, {}};
}

/// Keeps the map that the layer has where it is this one.
void load_thickness_map(LayerState& layer, const Thickness& thickness) {
    const auto& [file, derived, stops] = thickness;
    if (layer.thickness_file == file && layer.thickness_derived == derived) return;
    layer.thickness_file.clear();  // should the next line throw
    layer.thickness_map = file.empty() ? Image{} : load_map(file, derived);
    layer.thickness_file = file;
    layer.thickness_derived = derived;
}

}  // namespace

struct Pipeline::State {
    Scene scene;
    std::vector<LayerState> layers;
    std::vector<LayerStatistics> statistics;
    std::optional<Environment> environment;
    RenderCache render_cache;

    bool has_splats(std::size_t index) const { return layers[index].set || layers[index].streamed; }
    bool drawn(const Scene& now, std::size_t index) const {
        return now.layers[index].visible && has_splats(index);
    }

    /// Those of a frame that are visible at some moment, in file order.
    std::vector<std::size_t> drawn_layers(const FrameScene& frame) const {
        std::vector<std::size_t> drawn = shown_layers(frame);
        std::erase_if(drawn, [&](std::size_t i) { return !has_splats(i); });
        return drawn;
    }

    /// Stars of a picture whose layer is there already look through that.
    LoadedSet load_set(const LayerParams& params, const SetCache& cache, const Progress& progress) const {
        const SourceParams source = source_of(scene, params);
        const LayerParams* const like = like_layer(scene, params);
        const SplatSet* const there = like ? layers[like - scene.layers.data()].set.get() : nullptr;
        if (there) return {load_picture_stars(cache, source, params.name, *there, progress)};
        return load_source(cache, source, params.name, progress, nullptr, columns_read(look_of(params)));
    }

    /// Of a layer that is streamed.
    void open_layer(std::size_t index) {
        const LayerParams& params = scene.layers[index];
        LayerState& layer = layers[index];
        statistics[index].name = params.name;
        try {
            layer.streamed = std::make_unique<StreamedSet>(params.source.file);
            layer.box = layer.streamed->bounds();
            const std::string reason = why_not_streamed(layer.streamed->file(), look_of(params));
            if (!reason.empty()) throw InputError(reason);
            if (is_mixed_in_display_space(params.render))
                throw InputError("display values are made of all splats at once");
        } catch (const InputError& error) {
            throw InputError("layer '" + params.name + "': " + error.what());
        }
        check_extent(layer.box, params.name);
        load_thickness_map(layer, look_of(params).thickness);
        count_set(facts_of(layer), layer.streamed->file().splats(), statistics[index]);
    }

    void load_layer(std::size_t index, const SetCache& cache, const Progress& progress) {
        const LayerParams& params = scene.layers[index];
        LayerState& layer = layers[index];
        LayerStatistics& counts = statistics[index];
        counts.name = params.name;
        if (!ever_visible(scene, params)) return;
        const auto start = Clock::now();
        LoadedSet loaded = load_set(params, cache, progress);
        const auto set = std::make_shared<SplatSet>(std::move(loaded.set));
        layer.set = set;
        if (is_shaded_alike(scene, params.name) && !holds_gaussians(*set)) layer.to_use_up = set;
        layer.box = bounds(*layer.set);
        check_extent(layer.box, params.name);
        load_thickness_map(layer, look_of(params).thickness);
        count_set(*layer.set, layer.set->size(), counts);
        counts.cached = loaded.cached;
        counts.geometry_cached = loaded.geometry_cached;
        counts.generate_seconds = seconds_since(start);
        release_spare_pages();  // nothing of their sizes comes again, and frames are long
    }

    /// For every set the index of a layer that has it, of the same name if there are several, each once; else
    /// their number.
    std::vector<std::size_t> find_layers(const Scene& wanted, const SetList& sets) const {
        std::vector<std::size_t> found(sets.size(), layers.size());
        std::vector<char> used(layers.size(), 0);
        for (std::size_t i = 0; i < sets.size(); ++i) {
            for (std::size_t l = 0; sets[i] && l < layers.size(); ++l) {
                if (layers[l].set != sets[i] || used[l]) continue;
                if (found[i] == layers.size() || scene.layers[l].name == wanted.layers[i].name) found[i] = l;
            }
            if (found[i] < layers.size()) used[found[i]] = 1;
        }
        return found;
    }

    ShadingInputs shading_inputs(std::size_t index, const LayerParams& params, const Camera& seen) const {
        const LayerState& layer = layers[index];
        ShadingInputs shading{look_of(params),
                              look_inputs(params),
                              {},
                              is_mixed_in_display_space(params.render) && !facts_of(layer).stars};
        if (layer.set && !layer.set->harmonics.empty())
            shading.seen_from = seen_from(seen, render_layer(params));
        return shading;
    }

    /// Applies the look in the memory of what draws, if it can. A match with the picture asks for sums over
    /// all splats, and what is drawn once is made of the set's own memory.
    bool shade_there(std::size_t index, const LayerParams& params, const Camera& seen,
                     LookDevice* device) try {
        LayerState& layer = layers[index];
        if (!device || !layer.set || layer.to_use_up || layer.set->stars || holds_gaussians(*layer.set))
            return false;
        const ShadingInputs shading = shading_inputs(index, params, seen);
        const bool matches = shading.look.vertical.match == VerticalAlpha::Match::picture;
        if (layer.shaded_with == shading || shading.seen_from || shading.encoded || matches) return false;
        if (layer.shaded_there_with == shading) return true;
        const auto start = Clock::now();
        load_thickness_map(layer, shading.look.thickness);
        LookInputs inputs = shading.inputs;
        inputs.thickness_map = layer.thickness_file.empty() ? nullptr : &layer.thickness_map;
        layer.shaded_there_with.reset();
        const std::uint64_t stamp = new_stamp();
        const auto found =
            device->shade(*layer.set, layer.set_stamp, prepare_look(*layer.set, shading.look, inputs),
                          inputs.thickness_map, stamp);
        if (!found) return false;
        layer.there = {stamp, layer.set->size(), found->kept, found->largest_light, found->largest_star_light,
                       {}};
        layer.shaded_there_with = shading;
        statistics[index].drawn = found->kept;
        statistics[index].look_seconds += seconds_since(start);
        return true;
    } catch (const InputError&) {  // which shade() says of the layer
        return false;
    }

    /// Applies the look where anything that it depends on has changed since the last frame. Refusals, as of a
    /// matching that the layer's splats cannot have, name the layer.
    void shade(std::size_t index, const LayerParams& params, const Camera& seen,
               const Progress& progress) try {
        LayerState& layer = layers[index];
        ShadingInputs shading = shading_inputs(index, params, seen);
        LookInputs inputs = shading.inputs;
        if (layer.shaded_with == shading) return;
        load_thickness_map(layer, shading.look.thickness);
        inputs.thickness_map = layer.thickness_file.empty() ? nullptr : &layer.thickness_map;
        layer.shaded_with.reset();  // should an exception below leave old splats
        LookStatistics counts;
        Buffer<glm::vec3> colors;
        if (shading.seen_from) {
            colors = seen_colors(*layer.set, *shading.seen_from, progress);
            inputs.seen_colors = &colors;
        }
        if (layer.streamed) {
            const auto start = Clock::now();
            layer.streamed->set_look(shading.look, inputs, progress.silent());
            counts = {layer.streamed->splats(), seconds_since(start)};
        } else if (layer.to_use_up) {
            layer.shaded = apply_look_in_place(*layer.to_use_up, shading.look, inputs, progress, &counts);
            layer.to_use_up.reset();
        } else {
            apply_look(*layer.set, shading.look, inputs, layer.shaded, progress, &counts);
        }
        if (layer.set && holds_gaussians(*layer.set)) add_shapes(*layer.set, layer.shaded);
        layer.shaded.encoded = false;
        if (shading.encoded) encode_colors(layer.shaded);
        layer.shaded.stamp = new_stamp();
        layer.shaded_with = shading;
        statistics[index].drawn = layer.streamed ? layer.streamed->splats() : layer.shaded.size();
        statistics[index].look_seconds += counts.seconds;
    } catch (const NotEnoughMemory&) {
        throw;
    } catch (const InputError& error) {
        throw InputError("layer '" + params.name + "': " + error.what());
    }

    void shade_visible(const Scene& now, const Camera& seen, const Progress& progress,
                       LookDevice* device = nullptr) {
        for (std::size_t i = 0; i < now.layers.size(); ++i) {
            progress.check();
            if (!drawn(now, i)) continue;
            const LayerParams& layer = now.layers[i];
            check_extent(world_bounds(layers[i].box, render_layer(now, layer)), layer.name,
                         farthest_in_world);
            LayerState& state = layers[i];
            if (shade_there(i, layer, seen, device)) {
                state.there.make = [this, i, layer, seen, &progress, &state] {
                    shade(i, layer, seen, progress);
                    return &state.shaded;
                };
            } else {
                state.shaded_there_with.reset();
                shade(i, layer, seen, progress);
            }
        }
    }

    /// The layers to draw at a frame, in file order.
    std::vector<RenderLayer> visible_layers(const Scene& now) const {
        std::vector<RenderLayer> visible;
        for (std::size_t i = 0; i < now.layers.size(); ++i) {
            if (!drawn(now, i)) continue;
            const LayerState& state = layers[i];
            RenderLayer& layer = visible.emplace_back(render_layer(now, now.layers[i]));
            if (state.streamed)
                layer.blocks = state.streamed.get();
            else if (state.shaded_there_with)
                layer.on_device = &state.there;
            else
                layer.splats = &state.shaded;
            layer.absorbs = facts_of(state).absorbs;
            layer.gaussians = state.set && holds_gaussians(*state.set);
            if (state.set && !state.set->harmonics.empty()) layer.directional = state.set.get();
            layer.star_pixels = facts_of(state).star_pixels;
        }
        return visible;
    }

    Camera camera(const Scene& now, const RenderSettings& settings) const {
        Bounds box;
        for (std::size_t i = 0; i < now.layers.size(); ++i) {
            if (drawn(now, i)) box.add(world_bounds(layers[i].box, render_layer(now, now.layers[i])));
        }
        return make_camera(now.camera, double(settings.width), double(settings.height), box);
    }

    /// One rendering of the scene as it stands, through a place of the lens.
    RenderedFrame rendering(const Scene& now, const glm::dvec2& lens, const RenderSettings& settings,
                            const Progress& progress, const TileDone& tile_done) {
        const Camera middle = camera(now, settings);
        const bool flat = settings.device && !is_onto_sphere(now.camera.projection);
        shade_visible(now, middle, progress, flat ? settings.device->looks() : nullptr);
        const Camera seen = through_lens(middle, now.camera, lens, double(settings.width));
        return render(visible_layers(now), seen, environment_at(now), settings, progress, &render_cache,
                      tile_done);
    }

    const Environment* environment_at(const Scene& now) {
        if (!environment || !now.environment.visible) return nullptr;
        set_environment_params(*environment, now.environment);
        return &*environment;
    }
};

Pipeline::Pipeline() : state_(std::make_unique<State>()) {}

Pipeline::Pipeline(const Scene& scene, const Progress& progress, const SetCache& cache,
                   const std::vector<std::string>& streamed)
    : state_(std::make_unique<State>()) {
    if (has_environment(scene.environment))
        state_->environment = load_environment(scene.environment, progress.silent(), kept_skies(cache));
    state_->scene = scene;
    state_->layers.resize(scene.layers.size());
    state_->statistics.resize(scene.layers.size());
    const double count = double(std::max<std::size_t>(1, scene.layers.size()));
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        const LayerParams& layer = scene.layers[i];
        if (std::ranges::find(streamed, layer.name) != streamed.end() && ever_visible(scene, layer))
            state_->open_layer(i);
        else
            state_->load_layer(i, cache, progress.part(double(i) / count, double(i + 1) / count));
    }
}

Pipeline::~Pipeline() = default;

void Pipeline::set_scene(const Scene& scene, std::vector<std::shared_ptr<const SplatSet>> sets,
                         const Environment* loaded, const Progress& progress) {
    assert(sets.size() == scene.layers.size());
    State& state = *state_;
    // All that may throw comes first: what is moved out of the old scene below is lost to it.
    std::optional<Environment> environment;
    const bool has_other_pictures = pictures_of(scene.environment) != pictures_of(state.scene.environment);
    if (has_other_pictures && has_environment(scene.environment))
        environment = loaded ? *loaded : load_environment(scene.environment, progress.silent());
    const std::vector<std::size_t> old = state.find_layers(scene, sets);
    std::vector<LayerState> layers(sets.size());
    std::vector<LayerStatistics> statistics(sets.size());
    for (std::size_t i = 0; i < sets.size(); ++i) {
        statistics[i].name = scene.layers[i].name;
        if (!sets[i]) continue;
        count_set(*sets[i], sets[i]->size(), statistics[i]);
        if (old[i] < state.layers.size()) continue;
        layers[i].set = sets[i];
        layers[i].box = bounds(*sets[i]);
        check_extent(layers[i].box, scene.layers[i].name);
    }
    Scene taken = scene;
    for (std::size_t i = 0; i < sets.size(); ++i) {
        if (old[i] < state.layers.size()) layers[i] = std::move(state.layers[old[i]]);
        statistics[i].drawn = layers[i].shaded_there_with ? layers[i].there.kept : layers[i].shaded.size();
    }
    if (has_other_pictures) state.environment = std::move(environment);
    state.scene = std::move(taken);
    state.layers = std::move(layers);
    state.statistics = std::move(statistics);
}

FrameScene Pipeline::frame_scene(double number, std::optional<Eye> eye) const {
    return astrosplat::frame_scene(state_->scene, number, eye);
}

RenderedFrame Pipeline::frame(const FrameScene& frame, const RenderSettings& settings,
                              const Progress& progress, const TileDone& tile_done) {
    if (!frame.is_blurred()) return state_->rendering(frame.scene, {}, settings, progress, tile_done);
    const std::vector<std::size_t> drawn = state_->drawn_layers(frame);
    const auto samples = int(frame.samples.size());
    RenderSettings of_sample = settings;
    of_sample.opacity = settings.aov_depth;
    RenderedFrame sum;
    for (int i = 0; i < samples; ++i) {
        const Progress part = progress.part(double(i) / samples, double(i + 1) / samples);
        const Scene& then = frame.at_sample(std::size_t(i));
        std::vector<std::size_t> shown;  // at this moment, as indices of `drawn`
        for (std::size_t l = 0; l < drawn.size(); ++l)
            if (state_->drawn(then, drawn[l])) shown.push_back(l);
        const glm::dvec2& lens = frame.samples[i].lens;
        add_rendering(sum, state_->rendering(then, lens, of_sample, part, {}), shown);
    }
    divide_sum(sum, samples, settings.aov_layers ? drawn.size() : 0);
    const Region& region = settings.region;
    const Region whole{0, 0, settings.width, settings.height};
    if (tile_done) tile_done(region.width > 0 ? region : whole, sum);
    return sum;
}

std::vector<RenderLayer> Pipeline::shaded_layers(const FrameScene& frame, const Progress& progress) {
    const Scene& now = frame.scene;
    state_->shade_visible(now, state_->camera(now, render_settings(now.output)), progress);
    return state_->visible_layers(now);
}

RenderSettings render_settings(const OutputParams& output) {
    RenderSettings settings;
    settings.width = output.width;
    settings.height = output.height;
    settings.pixel_filter = float(output.pixel_filter);
    settings.exposure = float(output.exposure);
    settings.aov_depth = output.holds("depth");
    settings.aov_coverage = output.holds("coverage");
    settings.aov_count = output.holds("count");
    settings.aov_layers = output.holds("layers");
    return settings;
}

Camera Pipeline::camera(const FrameScene& frame, const RenderSettings& settings) const {
    return state_->camera(frame.scene, settings);
}

const std::vector<LayerStatistics>& Pipeline::statistics() const { return state_->statistics; }

std::vector<std::string> Pipeline::layer_names(const FrameScene& frame) const {
    std::vector<std::string> names;
    for (const std::size_t i : state_->drawn_layers(frame)) names.push_back(frame.scene.layers[i].name);
    return names;
}

ObjectMetadata Pipeline::input_metadata() const {
    std::vector<const SplatSetFacts*> sets;
    for (const LayerState& layer : state_->layers)
        sets.push_back(layer.set || layer.streamed ? &facts_of(layer) : nullptr);
    return source_metadata(state_->scene, sets);
}

std::string Pipeline::input_origin() const {
    std::string text;
    for (std::size_t i = 0; i < state_->layers.size(); ++i) {
        const LayerState& layer = state_->layers[i];
        if (!layer.set && !layer.streamed) continue;
        const LayerParams& params = state_->scene.layers[i];
        const std::string& stored = facts_of(layer).origin;
        const std::string origin = stored.empty() ? origin_of(params.source) : stored;
        if (!origin.empty()) text += fmt::format("{}{}: {}", text.empty() ? "" : " | ", params.name, origin);
    }
    return text;
}

}  // namespace astrosplat
