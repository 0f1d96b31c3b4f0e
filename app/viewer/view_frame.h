// One frame of the viewport: the preview while something changes, then the final frame, tile by tile, once
// the hand rests (DESIGN 10). In: what is to be seen. Out: a texture, and how far it is. The final frame is
// made in the background, by the offline renderer on a thread of its own: the pixels are the very bits of
// `--batch` at that size.
#pragma once

#include "core/image.h"
#include "edit/status.h"
#include "edit/view_state.h"
#include "gl/card.h"
#include "gl/objects.h"
#include "render/render.h"
#include "scene/scene.h"
#include "splats/splat_set.h"
#include "viewer/background_work.h"
#include "viewer/files.h"
#include "viewer/final_frames.h"
#include "viewer/preview_splats.h"

namespace astrosplat {

class Pipeline;

/// One frame to compute.
struct FinalRequest : FrameRequest {
    std::vector<std::shared_ptr<const SplatSet>> sets;  // one a layer; null: the layer is not drawn
    std::shared_ptr<const Environment> environment;     // of the scene, where it is loaded already
    bool depth = false;  // also RenderedFrame::depth; changes no pixel of the beauty
};

class FinalFrame {
  public:
    /// `card`: what draws, opened with the first frame.
    explicit FinalFrame(const CardChoice& card = {}) : work_(renderer(card)) {}

    /// Cancels what is under way and begins again. Returns at once.
    void start(FinalRequest request);
    /// Cancels and returns at once: state() is idle from then on, and the thread stops within 50 ms of work.
    void cancel();

    enum class State { idle, running, done, failed };
    struct Outcome {
        State state = State::idle;
        std::string error;  // failed
        // When done:
        double seconds = 0.0;  // from the thread's taking up the request to the last pixel
        std::shared_ptr<const RenderedFrame> frame;  // its beauty is region-sized
    };
    /// Once it is done before take_tiles(), that call makes the image whole.
    Outcome outcome() const;
    float progress() const;

    /// Tiles finished since the last call, copied into `image` (resized to the request's). Returns their
    /// regions, px of `image`. Never blocks on the renderer.
    std::vector<Region> take_tiles(Image& image);

  private:
    struct Run;
    using Work = LatestWork<std::shared_ptr<Run>, Outcome>;
    static Outcome render(Pipeline& pipeline, RenderDevice* device, Run& run, Progress progress);
    static Work::Work renderer(const CardChoice& card);

    std::shared_ptr<Run> run_;  // the latest; null before the first and after cancel()
    Work work_;
};

/// How previews are drawn.
struct PreviewChoice {
    RenderDevice* device = nullptr;  // that draws; null: the processor
    float share = 0.0f;              // of all splats; 1: every one; 0: sized by the frame rate
    std::int64_t splats = 0;         // with share 0: this many in all, whatever the frame rate; 0: by it
    bool refined = true;             // cuts of whole sets, once there is time to make them; else of samples
    bool steps = false;              // finer previews at rest though no final frame may begin
    bool arriving = false;           // sets come, each of which makes the last preview stale
    double target_ms = 25.0;         // of one preview
    double quick_s = 0.04;           // a card's final frame within this takes the place of previews
};

class ViewFrame {
  public:
    /// `kept`: where final frames are looked for and kept, which several views may share; null: nowhere.
    explicit ViewFrame(std::shared_ptr<PictureFiles> files, const CardChoice& card = {},
                       std::shared_ptr<FinalFrames> kept = nullptr)
        : files_(std::move(files)), kept_finals_(std::move(kept)), final_(card) {}

    /// Shows `request`: draws a preview where it differs from the last one, else goes on towards the final
    /// frame once nothing has been touched for 0.15 s (`settle`; `hurry`: at once). With `settle` one
    /// that is kept is shown at once; where the last one came quickly, from a card, the next one takes the
    /// preview's place. `now` in seconds.
    void show(const ViewRequest& request, const PreviewChoice& choice, bool settle, double now,
              bool hurry = false);
    unsigned texture() const { return texture_; }
    /// Grows whenever the texture's pixels change.
    std::uint64_t version() const { return version_; }
    const ViewFrameStatus& status() const { return status_; }
    /// show() should be called again soon although nothing was touched.
    bool waiting() const { return Stage::preview <= stage_ && stage_ <= Stage::refining; }
    /// Preview splats of each layer in the last preview.
    const std::vector<std::int64_t>& shown() const { return shown_; }
    /// Splats of each layer that its look keeps, estimated from the last preview; below 0: not known.
    const std::vector<std::int64_t>& kept() const { return kept_; }
    /// The preview is that of the present request, in order.
    bool exact() const;
    /// What is seen is no final frame yet.
    bool final_comes() const { return stage_ <= Stage::refining; }
    /// The hand rests, and the final frame is being made or will be as soon as everything is there for it.
    bool final_is_next(double now) const;
    /// Seconds until the final frame may begin.
    double due(double now) const;
    /// Linear RGBA as shown, region-sized; null before anything is.
    const Image* pixels() const;
    /// Light of every layer of the scene at a pixel of the whole frame, by the splats of the preview
    /// (preview_splats.h).
    std::vector<float> layer_light(std::int64_t x, std::int64_t y);
    /// Depth of what is seen at one, likewise (depth_at).
    std::optional<double> depth(std::int64_t x, std::int64_t y);
    /// The final frame, when status says so.
    std::shared_ptr<const RenderedFrame> final_frame() const;

  private:
    /// How far the frame is; view_frame.cpp states which stage may follow which.
    enum class Stage {
        empty,     // nothing has been asked for
        preview,   // drawn
        finer,     // and one of more splats or samples is on its way, while nothing is touched
        refining,  // tiles of the final frame replace the preview
        final,     // all have
        failed     // the status says why; until something else is to be seen
    };
    static constexpr bool may_follow(Stage now, Stage next);
    void enter(Stage next);

    std::vector<PreviewLayer> preview_layers();
    PreviewView preview_view() const;
    PreviewView view_through(const Camera& camera) const;
    std::int64_t splats_wanted() const;
    void cut(std::vector<PreviewLayer>& layers, const PreviewView& view);
    PreviewView view_of_layers();
    bool refine(double now);
    bool environment_arrived();
    bool previews_arrived(const ViewRequest& now) const;
    void draw_preview(double now);
    StepPlan plan() const;
    bool takes_steps(bool hurry) const;
    bool blurred() const;
    bool step_is_due(double now);
    std::int64_t splats_of_next(const StepPlan& plan) const;
    std::vector<PreviewMoment> moments(int samples) const;
    void begin_step(std::int64_t splats);
    bool take_step();
    void begin_final();
    bool take_kept();
    bool follow(double now);
    void take_final(double now);
    void start_over(double now);
    void come_closer(bool settle, double now, bool hurry);

    std::shared_ptr<PictureFiles> files_;
    std::shared_ptr<FinalFrames> kept_finals_;
    Stage stage_ = Stage::empty;
    std::optional<ViewRequest> request_;
    std::shared_ptr<const Environment> environment_;  // of the last preview
    PreviewChoice choice_;
    PreviewSplats splats_;
    DrawnPreview preview_;
    PreviewBudget budget_;
    bool waits_ = false;  // at rest, for sets that are being made
    FramePace pace_;
    FinalFrame final_;
    std::shared_ptr<const RenderedFrame> final_frame_;  // that is shown
    FinerPreview finer_{finer_preview()};
    FinerRequest finer_request_;    // its number; the rest is with finer_
    int step_ = 0;                  // of finer previews, the last one begun
    int finer_samples_ = 1;         // of it
    Clock::time_point drawn_at_{};  // the last preview
    double draw_s_ = 0.0;           // the last preview or step took so long
    double final_s_ = -1.0;         // the last final frame; below 0: there was none
    bool quick_ = false;            // that was a card's, in no more time than a preview
    bool behind_ = false;           // what the preview drew is older than what is shown
    double followed_at_ = 0.0;      // when the last frame began that took a preview's place
    Image finer_image_, doubled_;
    double touched_at_ = 0.0;
    ImageTexture canvas_texture_;
    const Image* drawn_ = nullptr;  // the preview
    Image canvas_;                  // preview and tiles of the final frame, once that has begun
    unsigned texture_ = 0;
    std::uint64_t version_ = 0;  // of its pixels
    ViewFrameStatus status_;
    std::vector<std::int64_t> shown_, kept_;
    std::vector<PreviewLayer> layers_;  // that the last preview drew
    std::vector<std::size_t> places_;   // of these in the scene
};

}  // namespace astrosplat
