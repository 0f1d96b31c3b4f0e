// The quickest of a few frames counts: what disturbs one (a cut, another program) only makes it slower.
#include "viewer/preview_splats.h"

#include <iterator>

#include "core/parallel.h"
#include "core/progress.h"

namespace astrosplat {
namespace {

constexpr float least_share = 0.02f;  // of the brightest layer's light

/// Not split up by level of detail.
std::vector<RenderLayer> drawn_layers(const std::vector<PreviewLayer>& layers) {
    std::vector<RenderLayer> drawn;
    for (const PreviewLayer& layer : layers) drawn.emplace_back(layer.layer).render.lod = {};
    return drawn;
}

/// The pixel (x, y) and its neighbours within the view.
Region around(const PreviewView& view, std::int64_t x, std::int64_t y) {
    Region region{std::max<std::int64_t>(0, x - 1), std::max<std::int64_t>(0, y - 1), 0, 0};
    region.width = std::min(view.width, x + 2) - region.x;
    region.height = std::min(view.height, y + 2) - region.y;
    return region;
}

/// Of r, g and b.
double light_of(const Image& image) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (i % 4 != 3) sum += static_cast<double>(image.pixels[i]);
    return sum;
}

bool hides(const RenderLayer& layer) {
    return layer.absorbs || layer.render.holdout || layer.render.blend == Blend::absorb;
}

}  // namespace

PreviewView halved(const PreviewView& view) {
    PreviewView half = view;
    for (double* px : {&half.camera.focal_px, &half.camera.center_x_px, &half.camera.center_y_px}) *px *= 0.5;
    half.width = (view.width + 1) / 2;
    half.height = (view.height + 1) / 2;
    return half;
}

const Image& DrawnPreview::draw(const std::vector<PreviewLayer>& layers, const PreviewView& view,
                                const Progress& progress) {
    RenderSettings settings = settings_of(view);
    if (view.environment && !view.environment->faces->empty()) {
        draw_backdrop(*view.environment, view.camera, static_cast<int>(view.width),
                      static_cast<int>(view.height), backdrop_);
        settings.backdrop = &backdrop_;
    }
    settings.device = view.device;
    frame_ = render(drawn_layers(layers), view.camera, nullptr, settings, progress, &cache_).beauty;
    return frame_;
}

std::vector<float> light_of_layers(const std::vector<PreviewLayer>& layers, const PreviewView& view,
                                   std::int64_t x, std::int64_t y) {
    std::vector<float> light(layers.size());
    if (x < 0 || y < 0 || x >= view.width || y >= view.height) return light;
    const std::vector<RenderLayer> drawn = drawn_layers(layers);
    RenderSettings settings = settings_of(view);
    settings.region = around(view, x, y);
    settings.aov_layers = true;
    const RenderedFrame all = render(drawn, view.camera, view.environment, settings);
    settings.aov_layers = false;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        double own = light_of(all.layers[i]);
        if (hides(drawn[i])) {
            std::vector<RenderLayer> others = drawn;
            others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
            const Image without = render(others, view.camera, view.environment, settings).beauty;
            own = std::max(own, light_of(without) - light_of(all.beauty));
        }
        light[i] = static_cast<float>(own);
    }
    return light;
}

std::optional<double> depth_at(const std::vector<PreviewLayer>& layers, const PreviewView& view, double near,
                               double far, std::int64_t x, std::int64_t y) {
    constexpr double least = 0.01;  // of a pixel that is covered, or white
    if (x < 0 || y < 0 || x >= view.width || y >= view.height) return std::nullopt;
    const std::vector<RenderLayer> drawn = drawn_layers(layers);
    RenderSettings settings = settings_of(view);
    settings.region = around(view, x, y);
    const auto pixels = static_cast<double>(settings.region.width * settings.region.height);
    struct Seen {
        double cover = 0.0, light = 0.0;
    };
    const auto seen_to = [&](double depth) {
        Camera camera = view.camera;
        camera.far = depth;
        const Image image = render(drawn, camera, nullptr, settings).beauty;
        Seen seen{0.0, light_of(image) / (3.0 * pixels)};
        for (std::size_t i = 3; i < image.pixels.size(); i += 4)
            seen.cover += static_cast<double>(image.pixels[i]) / pixels;
        return seen;
    };
    const Seen all = seen_to(view.camera.far);
    double Seen::*const what = all.cover < least ? &Seen::light : &Seen::cover;
    if (all.*what < least) return std::nullopt;
    if (view.camera.far > 0.0) far = std::min(far, view.camera.far);
    near = std::max(near, view.camera.near);
    for (int i = 0; i < 10; ++i) {
        const double middle = 0.5 * (near + far);
        (seen_to(middle).*what < 0.5 * all.*what ? near : far) = middle;
    }
    return far;
}

std::vector<std::size_t> seen_layers(const std::vector<float>& light) {
    std::vector<std::size_t> seen;
    const float brightest = light.empty() ? 0.0f : *std::ranges::max_element(light);
    for (std::size_t i = 0; i < light.size(); ++i)
        if (light[i] > least_share * brightest) seen.push_back(i);
    std::ranges::stable_sort(seen, std::greater<>(), [&](std::size_t i) { return light[i]; });
    return seen;
}

std::optional<std::size_t> clicked_layer(const std::vector<std::size_t>& seen, std::size_t selected,
                                         bool behind) {
    if (seen.empty()) return std::nullopt;
    const auto found = std::ranges::find(seen, selected);
    if (!behind || found == seen.end() || found + 1 == seen.end()) return seen.front();
    return *(found + 1);
}

namespace {

/// The share of the splats that step 1, 2 .. draws; 0: there is no such step.
double share_of_step(int step) {
    constexpr double shares[] = {0.05, 0.2};
    return step >= 1 && step <= static_cast<int>(std::size(shares)) ? shares[step - 1] : 0.0;
}

FoundSums make_sums(const SumsRequest& request, const Progress& progress) {
    const Shading& shading = request.shading;
    ShadedSplats splats = apply_look(*request.source.set, shading.look, shading.inputs, progress);
    return {merge_splats(request.source, std::move(splats), progress), {}};
}

using SharedSplats = std::shared_ptr<const ShadedSplats>;

/// Gives the layers their splats, which live in what is returned; of stars those that they have.
std::vector<SharedSplats> cut_layers(std::vector<PreviewLayer>& layers, std::span<const CutSource> sources,
                                     const PreviewView& view, std::int64_t budget, float least_px) {
    const RenderSettings frame = settings_of(view);
    std::vector<CutLayer> seen;
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (const CutSource& source = sources[i]; source.merged)
            seen.push_back(
                {source.merged.get(), source.merging.get(),
                 make_projection(layers[i].layer, static_cast<std::uint16_t>(i), view.camera, frame),
                 source.relight.get()});
    std::vector<ShadedSplats> cut = cut_splats(seen, {budget, least_px, view.width, view.height});
    std::vector<SharedSplats> splats;
    for (std::size_t i = 0, next = 0; i < layers.size(); ++i) {
        RenderLayer& layer = layers[i].layer;
        splats.push_back(sources[i].stars);
        if (sources[i].merged) {
            if (is_mixed_in_display_space(layer.render)) encode_colors(cut[next]);
            splats.back() = std::make_shared<const ShadedSplats>(std::move(cut[next++]));
            layer.render.opacity = 1.0f;
        }
        layer.splats = splats.back().get();
    }
    return splats;
}

/// Adds a share of it.
void add_share(const Image& image, float share, Image& sum) {
    if (sum.pixels.empty()) sum = make_image(image.width, image.height, image.channels);
    parallel_each(sum.pixels.size(), 1 << 16,
                  [&](std::size_t i) { sum.pixels[i] += share * image.pixels[i]; });
}

FinerFound draw_finer(const FinerRequest& request, DrawnPreview& preview, const Progress& progress) {
    const auto start = Clock::now();
    const auto moments = static_cast<std::int64_t>(request.moments.size());
    FinerFound found;
    for (const PreviewMoment& moment : request.moments) {
        std::vector<PreviewLayer> layers(moment.layers.size());
        for (std::size_t i = 0; i < layers.size(); ++i) layers[i].layer = moment.layers[i];
        const std::vector<SharedSplats> splats =
            cut_layers(layers, moment.sources, moment.view, request.budget, CutSettings().least_px);
        progress.check();
        for (const SharedSplats& of_layer : splats) found.shown += of_layer->size();
        const Image& drawn = preview.draw(layers, moment.view, progress);
        if (moments == 1)
            found.image = drawn;
        else
            add_share(drawn, 1.0f / static_cast<float>(moments), found.image);
    }
    found.shown /= std::max<std::int64_t>(1, moments);
    found.seconds = seconds_since(start);
    return found;
}

}  // namespace

void PreviewBudget::measured(double milliseconds, double target_ms, std::int64_t shown) {
    constexpr double dead_zone = 1.0 / 8.0, far_off = 2.0;
    quickest_ms_ = frames_ == 0 ? milliseconds : std::min(quickest_ms_, milliseconds);
    ++frames_;
    const double wanted =
        target_ms / std::max(quickest_ms_, 1e-3);  // times as many, were all costs per splat
    const bool waits = frames_ < window && !(wanted * far_off < 1.0 && frames_ >= 2);
    if (waits) return;
    frames_ = 0;
    if (std::fabs(wanted - 1.0) <= dead_zone) return;
    if (wanted > 1.0 && shown < splats - splats / 8) return;
    constexpr std::int64_t few = 100'000, many = 500'000;
    if (wanted < 1.0 && pixels == 1 && splats <= few) return static_cast<void>(pixels = 2);
    if (wanted > 1.0 && pixels == 2 && splats >= many) return static_cast<void>(pixels = 1);
    const double factor = std::clamp(std::sqrt(wanted), 0.5, 1.5);
    const double moved = static_cast<double>(splats) * factor;
    splats = std::clamp(static_cast<std::int64_t>(moved), least, most);
}

double FramePace::target_ms(double now_s, double most_ms) {
    constexpr double frame_ms = 1000.0 / 24.0, least_ms = 10.0, pause_ms = 200.0;
    const double rest_ms = 1000.0 * (now_s - drawn_at_s_) - preview_ms_;
    const bool follows = drawn_at_s_ >= 0.0 && rest_ms >= 0.0 && rest_ms < pause_ms;
    drawn_at_s_ = now_s;
    if (!follows) rests_ = 0;
    if (follows) rests_ms_[rests_++ % window] = rest_ms;
    // The quickest, because a slow hand waits between frames too.
    const int count = std::min(rests_, window);
    const double quickest = count > 0 ? *std::min_element(rests_ms_, rests_ms_ + count) : 0.0;
    return std::clamp(frame_ms - quickest, std::min(least_ms, most_ms), most_ms);
}

StepPlan plan_steps(double final_s) {
    constexpr double at_once_s = 0.3, quick_s = 2.5;
    if (0.0 <= final_s && final_s < at_once_s) return {};
    if (0.0 <= final_s && final_s < quick_s) return {1, 0.08};
    return {2, 0.4};
}

std::int64_t splats_of_step(int step, std::int64_t total, std::int64_t shown, double seconds, double most_s) {
    constexpr double least_gain = 1.5;  // times the splats shown: a step of fewer is not worth its time
    double splats = share_of_step(step) * static_cast<double>(total);
    const double most = static_cast<double>(shown) * (most_s > 0.0 && seconds > 0.0 ? most_s / seconds : 1e9);
    splats = std::min(splats, most);
    return splats < least_gain * static_cast<double>(shown) ? 0 : std::llround(splats);
}

int samples_of_step(int step, std::int64_t samples) {
    constexpr std::int64_t most[] = {4, 16};
    if (step < 1 || step > static_cast<int>(std::size(most))) return 0;
    return static_cast<int>(std::min(most[step - 1], samples));
}

FinerPreview::Work finer_preview() {
    return
        [preview = std::make_shared<DrawnPreview>()](const FinerRequest& request, const Progress& progress) {
            return draw_finer(request, *preview, progress);
        };
}

namespace {

/// As what is made of a mesh's lattice, and of a picture: both lie in rows.
bool is_even(const SplatSet& set) { return set.is_on_lattice() || !set.radius.empty(); }

}  // namespace

PreviewSplats::PreviewSplats() : work_(make_sums) {}

/// The state that is kept of the layer with this set: when a layer before it is hidden, the others stay.
PreviewSplats::Layer& PreviewSplats::layer_at(std::size_t index, const LoadedLayer& loaded) {
    const auto first = layers_.begin() + static_cast<std::ptrdiff_t>(std::min(index, layers_.size()));
    const auto found =
        std::find_if(first, layers_.end(), [&](const Layer& l) { return l.sample == loaded.sample; });
    if (found != layers_.end()) {
        std::iter_swap(layers_.begin() + static_cast<std::ptrdiff_t>(index), found);
    } else {
        layers_.emplace(first);
        layers_[index].sample = loaded.sample;
    }
    layers_[index].whole = loaded.whole;
    return layers_[index];
}

void PreviewSplats::shade(Layer& layer, const PreviewLayer& wanted) {
    const bool stars = wanted.layer.stars.has_value();
    if (!stars && (!layer.merging || !(layer.merging->render == wanted.layer.render)))
        layer.merging = std::make_shared<const MergeSettings>(wanted.layer.render, is_even(*wanted.set));
    Shading shading = shading_of(wanted);
    if (layer.shading == shading) return;
    layer.shading.reset();  // an exception below must not leave old splats under a new look
    if (!stars) {
        looks_changed_ = true;
        work_.forget();
    }
    ShadedSplats splats = apply_look(*layer.sample.set, shading.look, shading.inputs);
    layer.kept = static_cast<double>(splats.size()) /
                 static_cast<double>(std::max<std::int64_t>(1, layer.sample.set->size()));
    const std::shared_ptr<const Relight> last = std::move(layer.relight);
    layer.relight.reset();
    layer.of_sample.reset();
    if (layer.has_whole() && layer.whole_shading != shading)
        layer.relight =
            std::make_shared<const Relight>(layer.of_whole->merged, *layer.sample.set, splats, last.get());
    const bool of_whole = layer.has_whole() && (!layer.relight || layer.relight->is_true());
    if (stars)
        layer.splats = std::make_shared<const ShadedSplats>(std::move(splats));
    else if (!of_whole)
        layer.of_sample = std::make_shared<const MergedSplats>(merge_splats(layer.sample, std::move(splats)));
    layer.shading = std::move(shading);
}

void PreviewSplats::cut(std::vector<PreviewLayer>& layers,
                        std::span<const std::shared_ptr<const LoadedLayer>> loaded, const PreviewView& view,
                        std::int64_t budget, float least_px) {
    for (std::size_t i = 0; i < layers.size(); ++i) shade(layer_at(i, *loaded[i]), layers[i]);
    layers_.resize(layers.size());
    std::vector<SharedSplats> splats = cut_layers(layers, sources(), view, budget, least_px);
    for (std::size_t i = 0; i < layers.size(); ++i) layers_[i].splats = std::move(splats[i]);
}

std::optional<SumsRequest> PreviewSplats::missing() const {
    for (const Layer& layer : layers_)
        if (layer.whole.tree && layer.shading && layer.whole_shading != layer.shading)
            return SumsRequest{layer.whole, *layer.shading};
    return std::nullopt;
}

bool PreviewSplats::whole() const {
    return std::ranges::all_of(layers_, [](const Layer& layer) {
        return !layer.sample.tree || layer.sample.weight <= 1.0f || !layer.of_sample;
    });
}

std::int64_t PreviewSplats::finest() const {
    std::int64_t finest = 0;
    for (const Layer& layer : layers_) {
        const bool of_leaves = layer.of_sample && layer.sample.weight > 1.0f;
        if (layer.sample.tree)
            finest += of_leaves ? std::ssize(layer.sample.tree->nodes) / 2 : layer.best()->splats.size();
    }
    return finest;
}

bool PreviewSplats::refine(double now) {
    constexpr double rest_s = 0.1;
    if (std::exchange(looks_changed_, false)) at_rest_since_ = now;
    if (now - at_rest_since_ < rest_s) return false;
    const std::optional<SumsRequest> wanted = missing();
    if (!wanted) return false;
    work_.want(*wanted);
    const std::shared_ptr<const FoundSums> found = work_.found(*wanted);
    if (!found) return false;
    for (Layer& layer : layers_) {
        if (!(layer.whole == wanted->source) || layer.shading != wanted->shading) continue;
        layer.whole_shading = layer.shading;
        if (!found->error.empty()) continue;  // what is drawn stays
        layer.of_whole = found;
        layer.relight.reset();
        layer.of_sample.reset();
    }
    work_.forget();  // or sums under a look would outlive it
    return found->error.empty();
}

std::vector<CutSource> PreviewSplats::sources() const {
    std::vector<CutSource> sources;
    for (const Layer& layer : layers_) {
        if (layer.sample.tree)
            sources.push_back(
                {layer.best(), layer.of_sample ? nullptr : layer.relight, layer.merging, nullptr});
        else
            sources.push_back({nullptr, nullptr, nullptr, layer.splats});
    }
    return sources;
}

std::vector<double> PreviewSplats::kept() const {
    std::vector<double> shares;
    for (const Layer& layer : layers_) shares.push_back(layer.kept);
    return shares;
}

}  // namespace astrosplat
