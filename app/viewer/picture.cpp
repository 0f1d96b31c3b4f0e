#include "viewer/picture.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <future>
#include <map>
#include <optional>

#include "core/clock.h"
#include "core/error.h"
#include "gl/picture_texture.h"
#include "look/apply.h"
#include "scene/layer_setup.h"
#include "source/texture.h"

namespace astrosplat {

/// Pictures by file, loaded when first asked for and kept while the viewer runs.
class PictureFiles {
  public:
    const Image& map(const std::filesystem::path& file) {
        std::unique_ptr<Image>& image = maps_[file];
        if (!image) image = std::make_unique<Image>(load_raw_image(file));
        return *image;
    }
    /// With gain and rotation of `params`; null where there is none to be seen, and while it is being loaded.
    /// Throws InputError where it cannot be.
    std::shared_ptr<const Environment> environment(const EnvironmentParams& params) {
        wanted_ = {};
        renewing_ = false;
        if (!has_environment(params) || !params.visible) return nullptr;
        const Files files{params.image, params.cube};
        if (!environments_.count(files)) {
            if (environments_.size() >= most_environments)
                std::erase_if(environments_, [](const auto& entry) { return is_ready(entry.second); });
            environments_[files] =
                std::async(std::launch::async, [params] { return load_environment(params); });
        }
        if (const auto renewed = renewed_.find(files); renewed != renewed_.end()) {
            renewing_ = !is_ready(renewed->second);
            if (!renewing_) environments_[files] = renewed->second;
            if (!renewing_) renewed_.erase(renewed);
        }
        wanted_ = environments_[files];
        if (!is_ready(wanted_)) return nullptr;
        Environment environment = wanted_.get();
        set_environment_params(environment, params);
        return std::make_shared<const Environment>(std::move(environment));
    }
    /// The environment asked for last is on its way.
    bool loading() const { return renewing_ || (wanted_.valid() && !is_ready(wanted_)); }
    /// Maps are read again when next asked for, environments at once; the old ones are seen until then.
    void forget(const std::vector<std::filesystem::path>& files);

  private:
    using Files = std::pair<std::filesystem::path, std::vector<std::filesystem::path>>;
    using Loading = std::shared_future<Environment>;
    static bool is_ready(const Loading& loading) {
        return loading.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    }

    static constexpr std::size_t most_environments = 3;
    std::map<std::filesystem::path, std::unique_ptr<Image>> maps_;
    std::vector<std::unique_ptr<Image>> old_maps_;  // so that new ones do not get their addresses
    std::map<Files, Loading> environments_;  // what is compared may have another one; also those that failed
    Loading wanted_;                         // asked for last
    std::map<Files, Loading> renewed_;       // of files that were changed, until asked for
    bool renewing_ = false;                  // one is on its way for what was asked for last
};

void PictureFiles::forget(const std::vector<std::filesystem::path>& files) {
    const auto is_changed = [&](const std::filesystem::path& file) {
        return std::find(files.begin(), files.end(), file) != files.end();
    };
    old_maps_.clear();
    for (const std::filesystem::path& file : files)
        if (auto map = maps_.extract(file)) old_maps_.push_back(std::move(map.mapped()));
    for (const auto& entry : environments_) {
        EnvironmentParams params;
        params.image = entry.first.first;
        params.cube = entry.first.second;
        if (!is_changed(params.image) && std::none_of(params.cube.begin(), params.cube.end(), is_changed))
            continue;
        renewed_[entry.first] = std::async(std::launch::async, [params] { return load_environment(params); });
    }
}

void forget(PictureFiles& pictures, const std::vector<std::filesystem::path>& files) {
    pictures.forget(files);
}

std::shared_ptr<PictureFiles> make_picture_files() { return std::make_shared<PictureFiles>(); }

namespace {

/// Histograms may come later than the set. What grows has none yet, and every sample of it is another.
bool same_set(const std::shared_ptr<const LoadedLayer>& a, const std::shared_ptr<const LoadedLayer>& b) {
    const auto set_of = [](const LoadedLayer& layer) { return layer.set ? layer.set : layer.preview; };
    return (a ? set_of(*a) : nullptr) == (b ? set_of(*b) : nullptr);
}

}  // namespace

bool PictureRequest::operator==(const PictureRequest& other) const {
    return width == other.width && height == other.height && files == other.files &&
           region.x == other.region.x && region.y == other.region.y && region.width == other.region.width &&
           region.height == other.region.height &&
           std::equal(layers.begin(), layers.end(), other.layers.begin(), other.layers.end(), same_set) &&
           scene == other.scene;
}

Camera camera_of(const PictureRequest& request) {
    return make_camera(request.scene.camera, request.width, request.height, request.box);
}

namespace {

constexpr std::int64_t small_layer = 15'000;  // splats that a preview shows of any layer
constexpr double rest_s = 0.3;                // without a change, before the final picture begins

double milliseconds_since(Clock::time_point start) { return 1e3 * seconds_since(start); }

Region whole(const PictureRequest& request) {
    if (request.region.width > 0) return request.region;
    return {0, 0, request.width, request.height};
}

}  // namespace

struct ViewPicture::Impl {
    std::shared_ptr<PictureFiles> files;
    std::optional<PictureRequest> request;
    std::shared_ptr<const Environment> environment;  // of the last preview
    PreviewChoice choice;
    CpuPreview cpu;
    std::unique_ptr<GlPreview> gl;  // made when first wanted
    PreviewBudget budget;
    FramePace pace;
    FinalPicture final;
    bool final_started = false;
    double changed_at = 0.0;
    PictureTexture canvas_texture;
    const Image* drawn = nullptr;  // the processor's preview; null while the GPU's is shown
    Image canvas;                  // preview and tiles of the final picture, once that has begun
    unsigned texture = 0;
    std::uint64_t version = 0;  // of its pixels
    PictureStatus status;
    std::vector<std::int64_t> shown, kept;
    std::vector<std::size_t> places;  // in the scene, of the layers that the last preview drew

    std::vector<PreviewLayer> preview_layers();
    void note_kept(const std::vector<double>& shares);
    bool environment_arrived();
    bool previews_arrived(const PictureRequest& now) const;
    void draw_preview(double now);
    void take_final();
    void begin_final();
};

std::vector<PreviewLayer> ViewPicture::Impl::preview_layers() {
    std::vector<PreviewLayer> layers;
    std::vector<std::int64_t> sizes;  // of the layers seen
    places.clear();
    shown.assign(request->layers.size(), 0);
    status.total = 0;
    for (std::size_t i = 0; i < request->layers.size(); ++i) {
        const LayerParams& params = request->scene.layers[i];
        const std::shared_ptr<const LoadedLayer>& loaded = request->layers[i];
        if (!params.visible || !loaded || loaded->splats == 0) continue;
        PreviewLayer layer;
        layer.layer = render_layer(params);
        layer.set = loaded->preview;
        layer.whole = loaded->splats;
        layer.look = params.look;
        layer.inputs = look_inputs(params);
        if (!params.look.thickness.map.empty())
            layer.inputs.thickness_map = &files->map(params.look.thickness.map);
        status.total += loaded->splats;
        sizes.push_back(loaded->splats);
        places.push_back(i);
        layers.push_back(std::move(layer));
    }
    const std::int64_t most = choice.splats > 0 ? choice.splats : budget.splats;
    const float share = choice.share > 0.0f ? choice.share : share_for_budget(sizes, most);
    for (std::size_t n = 0; n < layers.size(); ++n) {
        // A share of a small layer, such as a star cluster, would lose what it is made of.
        const auto small = static_cast<float>(small_layer) / static_cast<float>(sizes[n]);
        layers[n].share = std::min(1.0f, std::max(share, choice.share > 0.0f ? 0.0f : small));
        shown[places[n]] = shown_count(layers[n]);
    }
    return layers;
}

void ViewPicture::Impl::note_kept(const std::vector<double>& shares) {
    kept.assign(request->layers.size(), -1);
    for (std::size_t n = 0; n < std::min(shares.size(), places.size()); ++n) {
        const auto whole = static_cast<double>(request->layers[places[n]]->splats);
        kept[places[n]] = std::llround(shares[n] * whole);
    }
}

/// The environment of the picture shown has been loaded since, or could not be: then the preview says why.
bool ViewPicture::Impl::environment_arrived() {
    try {
        if (!request) return false;
        const std::shared_ptr<const Environment> now = files->environment(request->scene.environment);
        return (now ? now->faces : nullptr) != (environment ? environment->faces : nullptr);
    } catch (const InputError&) {
        return status.state != PictureState::failed;
    }
}

/// There is more to be shown of the same sets. Once the final picture has begun nobody needs it.
bool ViewPicture::Impl::previews_arrived(const PictureRequest& now) const {
    const auto same_preview = [](const auto& a, const auto& b) {
        return (a ? a->preview : nullptr) == (b ? b->preview : nullptr);
    };
    return !std::equal(request->layers.begin(), request->layers.end(), now.layers.begin(), now.layers.end(),
                       same_preview);
}

void ViewPicture::Impl::draw_preview(double now) {
    const auto start = Clock::now();
    const double target_ms = pace.target_ms(now, choice.target_ms);
    ++version;
    Camera camera = camera_of(*request);
    const Region part = whole(*request);
    camera.center_x_px -= static_cast<double>(part.x);
    camera.center_y_px -= static_cast<double>(part.y);
    const std::vector<PreviewLayer> layers = preview_layers();
    environment = files->environment(request->scene.environment);
    const auto filter = static_cast<float>(request->scene.output.pixel_filter);
    const int width = static_cast<int>(part.width), height = static_cast<int>(part.height);
    if (choice.opengl) {
        if (!gl) gl = std::make_unique<GlPreview>();
        texture = gl->draw(layers, camera, environment.get(), width, height, filter);
        drawn = nullptr;
        status.shown = gl->shown();
    } else {
        drawn = &cpu.draw(layers, camera, environment.get(), width, height, filter);
        canvas_texture.upload(*drawn);
        texture = canvas_texture.handle();
        status.shown = cpu.shown();
        note_kept(cpu.kept());
    }
    pace.drew(milliseconds_since(start));
    budget.measured(milliseconds_since(start), target_ms, status.shown);
    status.state = PictureState::preview;
    status.width = request->width;
    status.height = request->height;
    status.error.clear();
}

void ViewPicture::Impl::begin_final() {
    FinalRequest wanted;
    wanted.scene = request->scene;
    for (std::size_t i = 0; i < request->layers.size(); ++i) {
        const std::shared_ptr<const LoadedLayer>& loaded = request->layers[i];
        wanted.sets.push_back(loaded && request->scene.layers[i].visible ? loaded->set : nullptr);
    }
    wanted.environment = environment;
    wanted.files = request->files;
    wanted.width = request->width;
    wanted.height = request->height;
    wanted.region = request->region;
    wanted.depth = !request->scene.output.aovs.empty();
    canvas = drawn ? *drawn : gl->read();  // which the tiles replace
    if (!drawn) canvas_texture.upload(canvas);
    texture = canvas_texture.handle();
    final.start(std::move(wanted));
    final_started = true;
    status.state = PictureState::refining;
    status.progress = 0.0f;
}

void ViewPicture::Impl::take_final() {
    for (const Region& tile : final.take_tiles(canvas)) {
        canvas_texture.upload(canvas, tile);
        ++version;
    }
    texture = canvas_texture.handle();
    status.progress = final.progress();
    if (final.state() == FinalPicture::State::done) {
        status.state = PictureState::final;
        status.seconds = final.seconds();
    } else if (final.state() == FinalPicture::State::failed) {
        status.state = PictureState::failed;
        status.error = final.error();
    }
}

ViewPicture::ViewPicture(std::shared_ptr<PictureFiles> files) : impl_(std::make_unique<Impl>()) {
    impl_->files = std::move(files);
}
ViewPicture::~ViewPicture() = default;

void ViewPicture::show(const PictureRequest& request, const PreviewChoice& choice, bool settle, double now,
                       bool hurry) {
    Impl& self = *impl_;
    const bool changed = !self.request || !(*self.request == request) ||
                         self.choice.opengl != choice.opengl || self.choice.share != choice.share ||
                         self.environment_arrived();
    const bool fuller = !changed && !self.final_started && self.previews_arrived(request);
    if (changed || fuller || (self.gl && self.gl->sorting())) {
        self.final.cancel();
        self.final_started = false;
        if (changed) self.changed_at = now;
        self.request = request;
        self.choice = choice;
        try {
            self.draw_preview(now);
        } catch (const InputError& error) {
            self.status.state = PictureState::failed;
            self.status.error = error.what();
            self.final_started = true;  // which would meet the same
        }
        return;
    }
    if (self.status.state == PictureState::failed) return;
    if (!self.final_started) {
        if (self.files->loading()) return;
        if (settle && (hurry || now - self.changed_at >= rest_s)) self.begin_final();
    } else if (self.status.state == PictureState::refining) {
        self.take_final();
    }
}

void ViewPicture::stop() {
    impl_->final.cancel();
    if (impl_->status.state == PictureState::refining) impl_->status.state = PictureState::preview;
    impl_->final_started = false;
}

unsigned ViewPicture::texture() const { return impl_->texture; }
std::uint64_t ViewPicture::version() const { return impl_->version; }
const PictureStatus& ViewPicture::status() const { return impl_->status; }
bool ViewPicture::waiting() const {
    return impl_->status.state == PictureState::preview || impl_->status.state == PictureState::refining;
}
const std::vector<std::int64_t>& ViewPicture::shown() const { return impl_->shown; }
const std::vector<std::int64_t>& ViewPicture::kept() const { return impl_->kept; }

const Image* ViewPicture::pixels() const {
    if (impl_->final_started && impl_->canvas.width > 0) return &impl_->canvas;
    return impl_->drawn;
}

Image ViewPicture::read() const {
    const Image* image = pixels();
    return image ? *image : impl_->gl->read();
}

double ViewPicture::due(double now) const { return std::max(0.0, impl_->changed_at + rest_s - now); }

bool ViewPicture::exact() const {
    return impl_->request && !impl_->files->loading() && !(impl_->gl && impl_->gl->sorting());
}

std::shared_ptr<const RenderedFrame> ViewPicture::final_frame() const {
    return impl_->status.state == PictureState::final ? impl_->final.frame() : nullptr;
}

}  // namespace astrosplat
