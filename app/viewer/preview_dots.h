// The splats that a preview draws of each layer: a cut through its tree (merge/README.md), of the whole set
// where its sums are there, else of a sample, whose sums take no time. In: layers, a camera and a number of
// dots. Out: shaded splats; and at rest, until the final frame comes, images of the same view with more of
// them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gl/preview_layer.h"
#include "merge/cut.h"
#include "viewer/background_work.h"
#include "viewer/cpu_preview.h"
#include "viewer/loaded_layer.h"

namespace astrosplat {

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
    std::shared_ptr<const DotSettings> dots;
    std::shared_ptr<const ShadedSplats> stars;
};

class PreviewDots {
  public:
    PreviewDots();

    /// Gives every layer its splats, about `budget` in all, which stay until the next call, with the layer's
    /// opacity in them; of stars all, without it. `loaded`: what each layer is made of; least_px: of a dot
    /// (merge/cut.h). Throws InputError where a look cannot be applied.
    void cut(std::vector<PreviewLayer>& layers, std::span<const std::shared_ptr<const LoadedLayer>> loaded,
             const PreviewView& view, std::int64_t budget, float least_px = CutSettings().least_px);
    /// The last cut was of samples where whole sets could be.
    bool lacks_sums() const { return missing().has_value(); }
    /// It was of whole sets: one of more dots would show more.
    bool whole() const;
    /// Goes on making them in the background, once looks have been at rest for a while: sums of a look that
    /// is dragged come too late, and take the processor from its preview. True: there are more of them now.
    /// `now` in seconds.
    bool refine(double now);
    /// Gives up what is being made, until refine() is called again.
    void rest() { work_.forget(); }
    /// Inputs of the last cut, for another one of more dots.
    std::vector<CutSource> sources() const;
    /// Of each layer the share of its splats that the look keeps, 0..1.
    std::vector<double> kept() const;

  private:
    struct Layer {
        MergeSource sample, whole;
        std::optional<Shading> shading;  // of the sums there are
        std::shared_ptr<const MergedSplats> of_sample;
        std::shared_ptr<const FoundSums> of_whole;  // with an error: there will be none
        std::shared_ptr<const DotSettings> dots;
        std::shared_ptr<const ShadedSplats> splats;

        std::shared_ptr<const MergedSplats> best() const {
            if (of_whole && of_whole->error.empty()) return {of_whole, &of_whole->merged};
            return of_sample;
        }
    };

    Layer& layer_at(std::size_t index, const LoadedLayer& loaded);
    void merge(Layer& layer, const PreviewLayer& wanted);
    void show_stars(Layer& layer, const PreviewLayer& wanted);
    std::optional<SumsRequest> missing() const;

    std::vector<Layer> layers_;
    bool looks_changed_ = false;  // since refine() was called
    double at_rest_since_ = 0.0;  // s
    LatestWork<SumsRequest, FoundSums> work_;
};

/// The view of a preview with more dots, drawn in the background.
struct FinerRequest {
    std::uint64_t number = 0;  // another one is another request
    std::vector<RenderLayer> layers;
    std::vector<CutSource> sources;  // of each layer
    PreviewView view;
    std::shared_ptr<const Environment> environment;  // of the view
    std::int64_t budget = 0;                         // dots
    bool operator==(const FinerRequest& other) const { return number == other.number; }
};

struct FinerFound {
    Image image;             // RGBA, linear
    std::int64_t shown = 0;  // dots
    double seconds = 0.0;
    std::string error;
};

using FinerPreview = LatestWork<FinerRequest, FinerFound>;
FinerPreview::Work finer_preview();

}  // namespace astrosplat
