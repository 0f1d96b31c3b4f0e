// One pipeline, used by the thread alone. Each request is a Run of its own, so that what a cancelled one
// still writes reaches nobody; tiles are copied into the run's canvas without a lock, since each is written
// once. The thread has the window's priority: the window sleeps between events, which serves it first, while
// a lower one would hold up the pool's threads at the end of every loop on a busy machine.
#include "viewer/view_frame.h"

#include <atomic>
#include <cstring>
#include <mutex>
#include <new>
#include <stdexcept>

#include "core/error.h"
#include "core/progress.h"
#include "edit/placement.h"
#include "frame/frame_scene.h"
#include "image/blur.h"
#include "look/apply.h"
#include "pipeline.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"

namespace astrosplat {
namespace {

void copy_tile(const Image& from, const Region& tile, Image& to) {
    const auto bytes = static_cast<std::size_t>(tile.width * from.channels) * sizeof(float);
    for (std::int64_t y = tile.y; y < tile.y + tile.height; ++y)
        std::memcpy(to.at(tile.x, y), from.at(tile.x, y), bytes);
}

}  // namespace

/// One request and its tiles.
struct FinalFrame::Run {
    FinalRequest request;
    std::atomic<float> progress{0.0f};
    Image canvas;               // region-sized RGBA; a tile is whole before it appears in `fresh`
    std::mutex mutex;           // for `fresh`
    std::vector<Region> fresh;  // px of the canvas
};

FinalFrame::Outcome FinalFrame::render(Pipeline& pipeline, RenderDevice* device, Run& run,
                                       Progress progress) {
    const auto start = Clock::now();
    const FinalRequest& request = run.request;
    const Region region = request.part();
    run.canvas = unfilled_image(region.width, region.height, 4);
    pipeline.set_scene(request.scene, request.sets, request.environment.get(), progress);
    const FrameScene now = pipeline.frame_scene(request.frame);
    RenderSettings settings = render_settings(now.scene.output);
    settings.width = request.width;
    settings.height = request.height;
    settings.region = request.region;
    settings.aov_depth = request.depth;
    settings.memory_limit_bytes = RenderSettings::what_is_free;
    settings.aov_coverage = settings.aov_count = settings.aov_layers = false;
    settings.device = device;
    progress.report = [&run](double fraction) { run.progress = static_cast<float>(fraction); };
    const TileDone tile_done = [&run, region](const Region& tile, const RenderedFrame& frame) {
        const Region here{tile.x - region.x, tile.y - region.y, tile.width, tile.height};
        copy_tile(frame.beauty, here, run.canvas);
        const std::lock_guard lock(run.mutex);
        run.fresh.push_back(here);
    };
    auto frame = std::make_shared<const RenderedFrame>(pipeline.frame(now, settings, progress, tile_done));
    run.progress = 1.0f;
    return {State::done, {}, seconds_since(start), std::move(frame)};
}

namespace {

/// The card of this thread, opened with its first frame. It goes with the thread, on which alone its context
/// can be current.
RenderDevice* card_of_thread(const CardChoice& choice) {
    thread_local bool opened = false;
    thread_local std::unique_ptr<OwnCard> card;
    if (!std::exchange(opened, true)) card = open_card(choice);
    return card ? &card->card() : nullptr;
}

}  // namespace

FinalFrame::Work::Work FinalFrame::renderer(const CardChoice& choice) {
    return [pipeline = std::make_shared<Pipeline>(), files = std::uint64_t{0}, choice](
               const std::shared_ptr<Run>& run, const Progress& progress) mutable {
        RenderDevice* const card = card_of_thread(choice);
        if (std::exchange(files, run->request.files) != files) pipeline = std::make_shared<Pipeline>();
        try {
            return render(*pipeline, card, *run, progress);
        } catch (const std::bad_alloc&) {
            throw std::runtime_error("not enough memory for the final frame");
        }
    };
}

void FinalFrame::start(FinalRequest request) {
    run_ = std::make_shared<Run>();
    run_->request = std::move(request);
    work_.want(run_);
}

void FinalFrame::cancel() {
    work_.forget();
    run_.reset();
}

FinalFrame::Outcome FinalFrame::outcome() const {
    if (!run_) return {};
    const std::shared_ptr<const Outcome> found = work_.found(run_);
    if (!found) return {State::running, {}, 0.0, {}};
    return found->error.empty() ? *found : Outcome{State::failed, found->error, 0.0, {}};
}

float FinalFrame::progress() const { return run_ ? run_->progress.load() : 0.0f; }

std::vector<Region> FinalFrame::take_tiles(Image& image) {
    if (!run_) return {};
    const Region region = run_->request.part();
    if (image.width != region.width || image.height != region.height || image.channels != 4)
        image = make_image(region.width, region.height, 4);
    std::vector<Region> tiles;
    {
        const std::lock_guard lock(run_->mutex);
        tiles.swap(run_->fresh);
    }
    for (const Region& tile : tiles) copy_tile(run_->canvas, tile, image);
    return tiles;
}

namespace {

constexpr double rest_s = 0.15;       // without a touch, before the final frame begins
constexpr double step_rest_s = 0.06;  // and before the first finer preview does
constexpr double arrivals_s = 0.25;   // between previews of sets that arrive

double milliseconds_since(Clock::time_point start) { return 1e3 * seconds_since(start); }

}  // namespace

Camera camera_of(const ViewRequest& request) {
    return make_camera(request.scene.camera, request.width, request.height, request.box);
}

/// Whatever is shown, something else may be to be seen, which begins with its preview, is kept or cannot be
/// drawn. Else the stages follow each other, and finer previews may come one after the other.
constexpr bool ViewFrame::may_follow(Stage now, Stage next) {
    switch (next) {
        case Stage::preview:
        case Stage::final:
        case Stage::failed:
            return true;
        case Stage::finer:
            return now == Stage::preview;
        case Stage::refining:
            return now == Stage::preview || now == Stage::final;
        case Stage::empty:
            break;
    }
    return false;
}

void ViewFrame::enter(Stage next) {
    using State = ViewFrameState;
    constexpr State states[] = {State::loading,  State::preview, State::preview,
                                State::refining, State::final,   State::failed};
    assert(may_follow(stage_, next));
    stage_ = next;
    status_.state = states[static_cast<std::size_t>(next)];
}

std::vector<PreviewLayer> ViewFrame::preview_layers() {
    std::vector<PreviewLayer> layers;
    places_.clear();
    shown_.assign(request_->layers.size(), 0);
    kept_.assign(request_->layers.size(), -1);
    status_.total = 0;
    status_.round_splats = false;
    for (std::size_t i = 0; i < request_->layers.size(); ++i) {
        const LayerParams& params = request_->scene.layers[i];
        const std::shared_ptr<const LoadedLayer>& loaded = request_->layers[i];
        if (!params.visible || !loaded || loaded->splats == 0) continue;
        PreviewLayer layer;
        layer.layer = render_layer(request_->scene, params);
        layer.set = loaded->set ? loaded->set : loaded->sample.set;
        layer.layer.absorbs = layer.set->absorbs;
        status_.round_splats = status_.round_splats || holds_gaussians(*layer.set);
        layer.layer.star_pixels = layer.set->star_pixels;
        layer.look = look_of(params);
        layer.inputs = look_inputs(params);
        if (const Thickness& thickness = layer.look.thickness; !thickness.map.empty())
            layer.inputs.thickness_map = &files_->map(thickness.map, thickness.derive);
        status_.total += loaded->splats;
        places_.push_back(i);
        layers.push_back(std::move(layer));
    }
    return layers;
}

std::int64_t ViewFrame::splats_wanted() const {
    if (choice_.share > 0.0f)
        return std::max<std::int64_t>(1, std::llround(double(choice_.share) * double(status_.total)));
    return choice_.splats > 0 ? choice_.splats : budget_.splats;
}

/// Gives the layers their splats, and notes how many their looks keep.
void ViewFrame::cut(std::vector<PreviewLayer>& layers, const PreviewView& view) {
    std::vector<std::shared_ptr<const LoadedLayer>> loaded;
    for (const std::size_t place : places_) loaded.push_back(request_->layers[place]);
    const float least_px = choice_.share >= 1.0f ? 0.0f : CutSettings().least_px;
    splats_.cut(layers, loaded, view, splats_wanted(), least_px);
    const std::vector<double> kept = splats_.kept();
    for (std::size_t n = 0; n < places_.size(); ++n)
        kept_[places_[n]] = std::llround(kept[n] * static_cast<double>(loaded[n]->splats));
}

/// The environment of the frame that is shown has been loaded since, or could not be: the preview says why.
bool ViewFrame::environment_arrived() {
    try {
        if (!request_) return false;
        const std::shared_ptr<const Environment> now = files_->environment(request_->scene.environment);
        return (now ? now->faces : nullptr) != (environment_ ? environment_->faces : nullptr);
    } catch (const InputError&) {
        return stage_ != Stage::failed;
    }
}

/// There is more to be shown of the same sets. Once the final frame has begun it is not needed.
bool ViewFrame::previews_arrived(const ViewRequest& now) const {
    const auto same_preview = [](const auto& a, const auto& b) {
        return (a ? a->sample : MergeSource()) == (b ? b->sample : MergeSource());
    };
    return !std::ranges::equal(request_->layers, now.layers, same_preview);
}

/// Sums of whole sets, while nothing more urgent needs the processor.
bool ViewFrame::refine(double now) {
    return choice_.refined && stage_ != Stage::refining && splats_.refine(now);
}

/// The part of the frame that is seen, as a frame of its own.
PreviewView ViewFrame::preview_view() const { return view_through(camera_of(*request_)); }

PreviewView ViewFrame::view_through(const Camera& camera) const {
    PreviewView view;
    const Region part = request_->part();
    view.camera = camera;
    view.camera.center_x_px -= static_cast<double>(part.x);
    view.camera.center_y_px -= static_cast<double>(part.y);
    view.environment = environment_.get();
    view.width = part.width;
    view.height = part.height;
    view.pixel_filter = static_cast<float>(request_->scene.output.pixel_filter);
    view.device = choice_.device;
    return view;
}

void ViewFrame::draw_preview(double now) {
    const auto start = Clock::now();
    const double target_ms = pace_.target_ms(now, choice_.target_ms);
    ++version_;
    layers_ = preview_layers();
    environment_ = files_->environment(request_->scene.environment);
    const PreviewView whole = preview_view();
    const bool halves =
        budget_.pixels == 2 && choice_.share == 0.0f && choice_.splats == 0 && !choice_.device;
    const PreviewView view = halves ? halved(whole) : whole;
    cut(layers_, view);
    status_.shown = 0;
    status_.samples = 1;
    for (std::size_t n = 0; n < layers_.size(); ++n)
        status_.shown += shown_[places_[n]] = shown_count(layers_[n]);
    drawn_ = &preview_.draw(layers_, view);
    if (halves) drawn_ = &(doubled_ = doubled(*drawn_, whole.width, whole.height));
    canvas_texture_.upload(*drawn_);
    texture_ = canvas_texture_.handle();
    behind_ = false;
    draw_s_ = (halves ? 2.0 : 1.0) * seconds_since(start);  // steps have all pixels
    drawn_at_ = Clock::now();
    pace_.drew(milliseconds_since(start));
    budget_.measured(milliseconds_since(start), target_ms, status_.shown);
    enter(Stage::preview);
    status_.width = request_->width;
    status_.height = request_->height;
    status_.error.clear();
}

/// As of a long frame where none may begin, for its sets are being made.
StepPlan ViewFrame::plan() const {
    constexpr double long_s = 10.0;
    return plan_steps(waits_ ? long_s : final_s_);
}

/// Steps of finer previews come before the final frame, where that takes its time.
bool ViewFrame::takes_steps(bool hurry) const {
    const bool more = choice_.share == 0.0f && !choice_.device && (splats_.whole() || waits_);
    return !hurry && (more || blurred()) && step_ < plan().count;
}

/// Whether the frame is the mean of several renderings, which its preview in motion is not.
bool ViewFrame::blurred() const { return is_blurred(request_->scene.camera); }

/// Splats of this step; 0: it would show little more, or take too long.
std::int64_t ViewFrame::splats_of_next(const StepPlan& steps) const {
    const double most_s = choice_.splats > 0 ? 0.0 : steps.most_s;
    if (!blurred()) {
        const std::int64_t finest = splats_.finest();
        if (2 * finest < 3 * status_.shown) return 0;  // where sets are made, of their samples
        return std::min(finest, splats_of_step(step_, status_.total, status_.shown, draw_s_, most_s));
    }
    constexpr double most_blurred_s = 2.0;  // the first step comes whatever it takes: nothing else is blurred
    const int samples = samples_of_step(step_, request_->scene.output.samples);
    const double would_take_s = draw_s_ / status_.samples * samples;
    if (samples <= status_.samples || (step_ > 1 && would_take_s > most_blurred_s)) return 0;
    return std::max<std::int64_t>(1, status_.shown);
}

/// Begins the next step, or passes it over. False: none is left.
bool ViewFrame::step_is_due(double now) {
    if (now - touched_at_ < step_rest_s) return true;
    const StepPlan steps = plan();
    for (++step_; step_ <= steps.count; ++step_)
        if (const std::int64_t n = splats_of_next(steps)) try {
                begin_step(n);
                return true;
            } catch (const InputError&) {  // a camera of some moment, which the final frame says
            }
    return false;
}

/// Places on the lens and moments of the shutter as of a final frame with so many samples.
std::vector<PreviewMoment> ViewFrame::moments(int samples) const {
    Scene scene = request_->scene;
    scene.output.samples = samples;
    const FrameScene frame = frame_scene(scene, request_->frame);
    const std::vector<CutSource> sources = splats_.sources();
    std::vector<PreviewMoment> moments;
    for (std::size_t i = 0; i < frame.samples.size(); ++i) {
        const Scene& then = frame.at_sample(i);
        PreviewMoment& moment = moments.emplace_back();
        const Camera middle = make_camera(then.camera, request_->width, request_->height, request_->box);
        moment.view = view_through(through_lens(middle, then.camera, frame.samples[i].lens, request_->width));
        moment.view.device = nullptr;  // which is the window's
        for (std::size_t n = 0; n < places_.size(); ++n) {
            const LayerParams& params = then.layers[places_[n]];
            if (!params.visible) continue;
            RenderLayer& layer = moment.layers.emplace_back(render_layer(then, params));
            layer.absorbs = layers_[n].layer.absorbs;
            layer.star_pixels = layers_[n].layer.star_pixels;
            moment.sources.push_back(sources[n]);
        }
    }
    return moments;
}

void ViewFrame::begin_step(std::int64_t splats) {
    FinerRequest wanted;
    wanted.number = ++finer_request_.number;
    finer_samples_ = blurred() ? samples_of_step(step_, request_->scene.output.samples) : 1;
    wanted.moments = moments(finer_samples_);
    wanted.environment = environment_;
    wanted.budget = splats;
    finer_.want(wanted);
    enter(Stage::finer);
}

/// False: it is still on its way.
bool ViewFrame::take_step() {
    const std::shared_ptr<const FinerFound> found = finer_.found(finer_request_);
    if (!found) return false;
    enter(Stage::preview);
    if (!found->error.empty()) return true;
    finer_image_ = found->image;
    finer_.forget();
    drawn_ = &finer_image_;
    canvas_texture_.upload(finer_image_);
    texture_ = canvas_texture_.handle();
    status_.shown = found->shown;
    status_.samples = finer_samples_;
    draw_s_ = found->seconds;
    ++version_;
    return true;
}

void ViewFrame::begin_final() {
    FinalRequest wanted{*request_, {}, environment_, !request_->scene.output.aovs.empty()};
    for (std::size_t i = 0; i < request_->layers.size(); ++i) {
        const std::shared_ptr<const LoadedLayer>& loaded = request_->layers[i];
        const bool drawn =
            ever_visible(request_->scene, request_->scene.layers[i]);  // while the shutter is open
        wanted.sets.push_back(loaded && drawn ? loaded->set : nullptr);
    }
    if (stage_ != Stage::final) canvas_ = *drawn_;  // which the tiles replace
    texture_ = canvas_texture_.handle();
    splats_.rest();
    final_.start(std::move(wanted));
    enter(Stage::refining);
    status_.progress = 0.0f;
}

/// False: no final frame of what is to be seen is kept.
bool ViewFrame::take_kept() {
    const FinalFrames::Kept* const kept = kept_finals_ ? kept_finals_->find(*request_) : nullptr;
    if (!kept) return false;
    try {
        environment_ = files_->environment(request_->scene.environment);
    } catch (const InputError&) {  // which the preview says
        return false;
    }
    final_.cancel();
    if (stage_ == Stage::finer) finer_.forget();
    enter(Stage::final);
    final_frame_ = kept->frame;
    canvas_ = kept->frame->beauty;
    canvas_texture_.upload(canvas_);
    texture_ = canvas_texture_.handle();
    ++version_;
    behind_ = true;
    status_.progress = 1.0f;
    status_.seconds = kept->seconds;
    status_.device = kept->frame->statistics.device;
    status_.width = request_->width;
    status_.height = request_->height;
    status_.error.clear();
    return true;
}

/// A frame of a card in place of the preview, over the last one. False: something is missing for that.
bool ViewFrame::follow(double now) {
    const auto& loaded = request_->layers;
    const bool whole = std::ranges::all_of(loaded, [](const auto& layer) { return !layer || layer->set; });
    if (stage_ != Stage::final || !quick_ || !whole || files_->loading()) return false;
    if (canvas_.width != request_->part().width || canvas_.height != request_->part().height) return false;
    try {
        environment_ = files_->environment(request_->scene.environment);
    } catch (const InputError&) {  // which the preview says
        return false;
    }
    begin_final();
    status_.state = ViewFrameState::final;
    followed_at_ = now;
    behind_ = true;
    return true;
}

void ViewFrame::take_final(double now) {
    const FinalFrame::Outcome outcome = final_.outcome();  // before the tiles, so that none is missing
    for (const Region& tile : final_.take_tiles(canvas_)) {
        canvas_texture_.upload(canvas_, tile);
        ++version_;
    }
    texture_ = canvas_texture_.handle();
    status_.progress = final_.progress();
    status_.seconds = outcome.seconds;
    status_.error = outcome.error;
    if (outcome.state == FinalFrame::State::done) {
        enter(Stage::final);
        final_frame_ = outcome.frame;
        final_s_ = outcome.seconds;
        if (kept_finals_) kept_finals_->keep(*request_, outcome.frame, outcome.seconds);
        status_.device = outcome.frame->statistics.device;
        quick_ = !outcome.frame->statistics.device.empty() && outcome.seconds < choice_.quick_s;
        refine(now);  // for when the hand moves again
    }
    if (outcome.state == FinalFrame::State::failed) enter(Stage::failed);
}

/// With the preview of what is to be seen now.
void ViewFrame::start_over(double now) {
    final_.cancel();
    if (stage_ == Stage::finer) finer_.forget();
    step_ = 0;
    try {
        draw_preview(now);
    } catch (const InputError& error) {  // which the final frame would meet, too
        enter(Stage::failed);
        status_.error = error.what();
    }
}

/// From the preview, towards the final frame.
void ViewFrame::come_closer(bool settle, double now, bool hurry) {
    if (files_->loading()) return;
    if (stage_ == Stage::finer && !take_step()) return;
    waits_ = !settle && choice_.steps;
    if ((settle || waits_) && takes_steps(hurry) && step_is_due(now)) return;
    if (settle && (hurry || now - touched_at_ >= rest_s)) begin_final();
}

void ViewFrame::show(const ViewRequest& request, const PreviewChoice& choice, bool settle, double now,
                     bool hurry) {
    const bool touched = !request_ || !ask_the_same(*request_, request) || choice_.device != choice.device ||
                         choice_.share != choice.share;
    const bool changed = touched || !have_same_sets(*request_, request) || environment_arrived();
    // What the card has nearly finished is not thrown away for the next frame, or none would be seen.
    const bool hurries = changed && behind_ && now - followed_at_ < 2.0 * choice.quick_s;
    if (hurries && stage_ == Stage::refining) take_final(now);
    if (hurries && stage_ == Stage::refining) return;
    choice_.steps = choice.steps;
    const bool may_wait = choice.arriving && !touched && stage_ <= Stage::finer && drawn_;
    if (may_wait && seconds_since(drawn_at_) < arrivals_s) return;
    const bool refined = request_ && refine(now);
    const bool fuller = !changed && stage_ <= Stage::finer && (refined || previews_arrived(request));
    if (changed || fuller) {
        if (touched) touched_at_ = now;
        request_ = request;
        choice_ = choice;
        if (settle && changed && (take_kept() || follow(now))) return;
        return start_over(now);
    }
    const bool is_preview = stage_ == Stage::preview || stage_ == Stage::finer;
    if (is_preview && settle && take_kept()) return;  // such as where playing stopped
    if (is_preview) return come_closer(settle, now, hurry);
    if (stage_ == Stage::refining) take_final(now);
}

const Image* ViewFrame::pixels() const {
    if (stage_ >= Stage::refining && canvas_.width > 0) return &canvas_;
    return drawn_;
}

double ViewFrame::due(double now) const {
    constexpr double soon_s = 0.02;  // steps end by themselves
    if (stage_ == Stage::finer || takes_steps(false)) return soon_s;
    return std::max(0.0, touched_at_ + rest_s - now);
}

bool ViewFrame::final_is_next(double now) const {
    return stage_ == Stage::refining || (stage_ <= Stage::finer && now - touched_at_ >= rest_s);
}

bool ViewFrame::exact() const {
    return request_ && !files_->loading() && !(choice_.refined && splats_.lacks_sums());
}

/// The preview's, whose layers are brought up to what is shown.
PreviewView ViewFrame::view_of_layers() {
    const PreviewView view = preview_view();
    if (std::exchange(behind_, false)) {
        layers_ = preview_layers();
        cut(layers_, view);
    }
    return view;
}

std::optional<double> ViewFrame::depth(std::int64_t x, std::int64_t y) {
    if (!request_ || stage_ == Stage::failed || request_->box.empty()) return std::nullopt;
    const PreviewView view = view_of_layers();
    double near = std::numeric_limits<double>::max(), far = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const double depth = view_depth(view.camera, request_->box.corner(corner));
        near = std::min(near, depth), far = std::max(far, depth);
    }
    if (is_onto_sphere(view.camera.projection)) near = 0.0;  // a side may be nearer than its corners
    const Region part = request_->part();
    return depth_at(layers_, view, near, far, x - part.x, y - part.y);
}

std::vector<float> ViewFrame::layer_light(std::int64_t x, std::int64_t y) {
    std::vector<float> light(request_ ? request_->layers.size() : 0);
    if (!request_ || stage_ == Stage::failed) return light;
    const PreviewView view = view_of_layers();
    const Region part = request_->part();
    const std::vector<float> drawn = light_of_layers(layers_, view, x - part.x, y - part.y);
    for (std::size_t n = 0; n < drawn.size(); ++n) light[places_[n]] = drawn[n];
    return light;
}

std::shared_ptr<const RenderedFrame> ViewFrame::final_frame() const {
    return stage_ == Stage::final ? final_frame_ : nullptr;
}

}  // namespace astrosplat
