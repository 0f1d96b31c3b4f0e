// The splats that a preview draws, and the frame made of them by the engine's renderer. How many: in
// motion a budget that follows the measured time of a frame, at rest a few steps of more; plain numbers in
// and out, no clock. Which of each layer: a cut through its tree (merge/README.md), of the whole set where
// its sums are there, under another look relit by a sample of it, else of that sample, whose sums take no
// time. In: layers, a camera and a number of splats. Out: shaded splats; the frame in motion, the light of
// each layer at a pixel; and at rest, until the final frame comes, images of the same view with more of them.
#pragma once

#include "camera/camera.h"
#include "look/apply.h"
#include "merge/cut.h"
#include "render/environment.h"
#include "render/render.h"
#include "splats/splat_set.h"
#include "viewer/background_work.h"
#include "viewer/loaded_layer.h"

namespace astrosplat {

/// One layer of the preview. Where `layer.splats` is given, these are drawn (merge/cut.h); else all of `set`,
/// under its look.
struct PreviewLayer {
    RenderLayer layer;
    std::shared_ptr<const SplatSet> set;
    Look look;
    LookInputs inputs;
};

/// Splats of a layer that are drawn, before its look drops any.
inline std::int64_t shown_count(const PreviewLayer& layer) {
    if (layer.layer.splats) return layer.layer.splats->size();
    return layer.set ? layer.set->size() : 0;
}

/// A number that differs, most likely, from that of another image at the same address.
inline float content_probe(const Image& image) {
    constexpr std::size_t looks = 97;  // at pixels, about
    auto sum = static_cast<float>(image.width);
    const std::size_t step = std::max<std::size_t>(1, image.pixels.size() / looks);
    for (std::size_t i = 0; i < image.pixels.size(); i += step) sum = 0.75f * sum + image.pixels[i];
    return sum;
}

/// All that a layer's splats are shaded with, beside its set: while it stays equal, they stay.
struct Shading {
    Look look;
    LookInputs inputs;
    float map_probe = 0.0f;  // tells another map at the address of an old one
    bool operator==(const Shading&) const = default;
};
inline Shading shading_of(const PreviewLayer& layer) {
    const Image* map = layer.inputs.thickness_map;
    return {layer.look, layer.inputs, map ? content_probe(*map) : 0.0f};
}

/// A frame as previews draw it.
struct PreviewView {
    Camera camera;
    const Environment* environment = nullptr;
    std::int64_t width = 0, height = 0;  // px
    float pixel_filter = 0.5f;           // px
    RenderDevice* device = nullptr;      // that draws; null: the processor
};

/// For the renderer's projections.
inline RenderSettings settings_of(const PreviewView& view) {
    RenderSettings settings;
    settings.width = view.width;
    settings.height = view.height;
    settings.pixel_filter = view.pixel_filter;
    return settings;
}

/// The same with a fourth of the pixels; its image is doubled (image/blur.h).
PreviewView halved(const PreviewView& view);

class DrawnPreview {
  public:
    /// Renders the layers' splats into an image that stays valid until the next call, by the view's device or
    /// the processor: the same bits. Splats are not split up by level of detail. Throws Cancelled.
    const Image& draw(const std::vector<PreviewLayer>& layers, const PreviewView& view,
                      const Progress& progress = {});

  private:
    RenderCache cache_;
    Image frame_, backdrop_;
};

/// Of each of the layers, which must have their splats, the light that arrives from it within a pixel of
/// (x, y), or where that is more the light that it keeps from arriving: dust and holdouts are seen by what
/// they hide. 0 outside the frame.
std::vector<float> light_of_layers(const std::vector<PreviewLayer>& layers, const PreviewView& view,
                                   std::int64_t x, std::int64_t y);

/// Depth (view_depth) down to which lies half of what covers the pixels within one of (x, y), or where what
/// is seen there covers nothing, as layers that add do, half of the light: between `near` and `far`, that of
/// the camera's nearest and farthest splats, to a thousandth of their distance. None where nothing is seen.
std::optional<double> depth_at(const std::vector<PreviewLayer>& layers, const PreviewView& view, double near,
                               double far, std::int64_t x, std::int64_t y);

/// Indices of the layers whose light is more than a fiftieth of the brightest one's, brightest first.
std::vector<std::size_t> seen_layers(const std::vector<float>& light);

/// The layer that a click selects: the brightest, or `behind` the next one after the selected layer, after
/// the last one the first again. None where nothing is seen.
std::optional<std::size_t> clicked_layer(const std::vector<std::size_t>& seen, std::size_t selected,
                                         bool behind);

/// Follows a target time, damped, and stays where it is within an eighth of the target: the frame's grain
/// changes under the eye with every move.
struct PreviewBudget {
    std::int64_t least = 30000, most = 4000000;  // splats
    std::int64_t splats = 200000;                // the budget
    /// Of the frame that one of the preview's covers, each way: 2 where the frame's own would leave the time
    /// for so few splats only that these were blotches.
    int pixels = 1;

    /// Takes in one frame that drew `shown` splats in `milliseconds`. A frame that drew fewer than the
    /// budget, because no more are there, does not raise it.
    void measured(double milliseconds, double target_ms, std::int64_t shown);

  private:
    static constexpr int window = 5;  // frames
    double quickest_ms_ = 0.0;        // of the last frames since the budget moved
    int frames_ = 0;                  // of them
};

/// The time that a frame has left for its preview besides the rest of the window, which a software rasteriser
/// draws as slowly as the frame.
class FramePace {
  public:
    /// For the preview about to be drawn at `now_s`: what 24 frames a second leave of a frame, in ms, at
    /// least 10 and at most `most_ms`.
    double target_ms(double now_s, double most_ms);
    /// The preview took so long.
    void drew(double milliseconds) { preview_ms_ = milliseconds; }

  private:
    static constexpr int window = 8;  // frames
    double drawn_at_s_ = -1.0, preview_ms_ = 0.0;
    double rests_ms_[window] = {};  // of the last frames that followed each other, the oldest overwritten
    int rests_ = 0;
};

/// Steps before a final frame, and how long each may take, s.
struct StepPlan {
    int count = 0;
    double most_s = 0.0;
};
/// For a final frame that is expected to take so long; below 0: not known. A quick one is not held up by more
/// than the rest that comes before it anyway.
StepPlan plan_steps(double final_s);

/// Splats of a step that are worth drawing after `shown` of `total` splats took `seconds`, within most_s; 0:
/// none are. No limit where most_s is 0.
std::int64_t splats_of_step(int step, std::int64_t total, std::int64_t shown, double seconds, double most_s);

/// Inputs of a layer's sums.
struct SumsRequest {
    MergeSource source;
    Shading shading;
    bool operator==(const SumsRequest&) const = default;
};
struct FoundSums {
    MergedSplats merged;
    std::string error;
};

/// The source of a layer's cuts, or, of stars, all of its splats. Does not change.
struct CutSource {
    std::shared_ptr<const MergedSplats> merged;  // null: stars
    std::shared_ptr<const Relight> relight;      // null: they are under the layer's look
    std::shared_ptr<const MergeSettings> merging;
    std::shared_ptr<const ShadedSplats> stars;
};

class PreviewSplats {
  public:
    PreviewSplats();

    /// Gives every layer its splats, about `budget` in all, which stay until the next call, with the layer's
    /// opacity in them; of stars all, without it. `loaded`: what each layer is made of; least_px: of a splat
    /// (merge/cut.h). Throws InputError where a look cannot be applied.
    void cut(std::vector<PreviewLayer>& layers, std::span<const std::shared_ptr<const LoadedLayer>> loaded,
             const PreviewView& view, std::int64_t budget, float least_px = CutSettings().least_px);
    /// The last cut was of samples where whole sets could be.
    bool lacks_sums() const { return missing().has_value(); }
    /// It was of whole sets: one of more splats would show more.
    bool whole() const;
    /// Splats of the finest cut there can be.
    std::int64_t finest() const;
    /// Goes on making them in the background, once looks have been at rest for a while: sums of a look that
    /// is dragged come too late, and take the processor from its preview. True: there are more. `now` in s.
    bool refine(double now);
    /// Gives up what is being made, until refine() is called again.
    void rest() { work_.forget(); }
    /// Inputs of the last cut, for another one of more splats.
    std::vector<CutSource> sources() const;
    /// Of each layer the share of its splats that the look keeps, 0..1.
    std::vector<double> kept() const;

  private:
    struct Layer {
        MergeSource sample, whole;
        std::optional<Shading> shading;  // of what is drawn
        std::shared_ptr<const MergedSplats> of_sample;
        std::shared_ptr<const FoundSums> of_whole;  // with an error: there will be none
        std::optional<Shading> whole_shading;       // of these
        std::shared_ptr<const Relight> relight;     // from that look to this one
        double kept = 1.0;                          // share of the splats
        std::shared_ptr<const MergeSettings> merging;
        std::shared_ptr<const ShadedSplats> splats;

        bool has_whole() const { return of_whole && of_whole->error.empty(); }
        std::shared_ptr<const MergedSplats> best() const {
            if (of_sample) return of_sample;
            return {of_whole, &of_whole->merged};
        }
    };

    Layer& layer_at(std::size_t index, const LoadedLayer& loaded);
    void shade(Layer& layer, const PreviewLayer& wanted);
    std::optional<SumsRequest> missing() const;

    std::vector<Layer> layers_;
    bool looks_changed_ = false;  // since refine() was called
    double at_rest_since_ = 0.0;  // s
    LatestWork<SumsRequest, FoundSums> work_;
};

/// Renderings that step 1, 2 .. of a blurred frame is the mean of, where the final one is that of `samples`:
/// few first. 0: there is no such step.
int samples_of_step(int step, std::int64_t samples);

/// One of the renderings that a preview is the mean of: where layers and camera are at that moment.
struct PreviewMoment {
    std::vector<RenderLayer> layers;
    std::vector<CutSource> sources;  // of each layer
    PreviewView view;
};

/// The view of a preview with more splats, or of a blurred frame, drawn in the background.
struct FinerRequest {
    std::uint64_t number = 0;  // another one is another request
    std::vector<PreviewMoment> moments;
    std::shared_ptr<const Environment> environment;  // of their views
    std::int64_t budget = 0;                         // splats of each
    bool operator==(const FinerRequest& other) const { return number == other.number; }
};

struct FinerFound {
    Image image;             // RGBA, linear
    std::int64_t shown = 0;  // splats of a moment
    double seconds = 0.0;
    std::string error;
};

using FinerPreview = LatestWork<FinerRequest, FinerFound>;
FinerPreview::Work finer_preview();

}  // namespace astrosplat
