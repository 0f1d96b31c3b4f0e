// What a session shows besides its frame: rendered frames, the front check, the preparation, thumbnails, the
// reference's alignment, and the jobs that render to files, with a finished frame. Each image is made in a
// background thread and uploaded once.
#include <fmt/format.h>

#include "core/error.h"
#include "edit/command_lines.h"
#include "frame/output_pattern.h"
#include "scene/animate.h"
#include "scene/frames.h"
#include "viewer/session.h"

namespace astrosplat {
namespace {

/// B alone, as large as `place` has room for it.
void show_alone(unsigned texture, bool is_display, glm::vec2 size_px, const Rect& place,
                DisplaySettings& shown) {
    const float scale = std::min(place.width / size_px.x, place.height / size_px.y);
    shown.b = texture;
    shown.b_is_display = is_display;
    shown.mode = DisplaySettings::Mode::b;
    shown.width = scale * size_px.x;
    shown.height = scale * size_px.y;
    shown.x = place.x + 0.5f * (place.width - shown.width);
    shown.y = place.y + 0.5f * (place.height - shown.height);
}

/// The files of the output's frames.
struct FrameFiles {
    OutputPattern pattern;
    Eye eye = Eye::centre;
    fs::path of(double frame) const { return pattern.resolve(std::llround(frame), eye); }
};

/// None where the output has one file for all frames, or a pattern that is wrong.
std::optional<FrameFiles> frame_files(const Scene& scene) try {
    const OutputPattern pattern = output_pattern(scene.file.parent_path(), scene.output.path);
    if (!pattern.is_numbered()) return std::nullopt;
    return FrameFiles{pattern, eyes_of(pattern, scene.camera).front()};
} catch (const InputError&) {
    return std::nullopt;
}

/// From the frame that is looked at on, as they are played.
std::vector<fs::path> files_ahead(const Session& session, const FrameFiles& files) {
    constexpr double most = 24.0;  // files: a second of film
    const std::vector<std::int64_t> frames =
        parse_frames(session.document.scene().output.frames, "output.frames");
    const double first = session.view.play_first.value_or(static_cast<double>(frames.front())),
                 last = session.view.play_last.value_or(static_cast<double>(frames.back()));
    std::vector<fs::path> ahead = {files.of(session.view.frame)};
    double frame = std::floor(session.view.frame);
    for (double i = 1.0; i < std::min(most, last - first + 1.0); ++i) {
        frame = frame + 1.0 > last ? first : frame + 1.0;
        ahead.push_back(files.of(frame));
    }
    return ahead;
}

bool wants_rendered(const Session& session) {
    const ViewState& view = session.view;
    return view.show_rendered && view.view == ViewKind::camera && view.compare == CompareMode::a &&
           !session.viewport_is_frame;
}

/// Of each layer what the final frame is made of; null: it is not seen.
std::vector<std::shared_ptr<const SplatSet>> sets_of(const Session& session, const Scene& now) {
    std::vector<std::shared_ptr<const SplatSet>> sets;
    for (const LayerParams& layer : now.layers) {
        const auto loaded = session.sets.loader().layer(layer.name);
        sets.push_back(loaded && layer.visible ? loaded->set : nullptr);
    }
    return sets;
}

/// Null: nothing is found yet.
std::shared_ptr<const FrontFound> check_front(Session& session, const Scene& now) {
    std::optional<FrontStatus>& status = session.status.front;
    const bool at_rest = session.view_frame.status().state == ViewFrameState::final;
    const bool shown = session.view.compare == CompareMode::front;
    status.reset();
    if (!at_rest) session.front.cancel();
    if (session.front.asked([&](const FrontRequest& asked) { return asked.sets != sets_of(session, now); }))
        session.front.forget();  // it would keep the sets of scenes that are closed
    if (session.viewport_is_frame || !has_front_picture(now) || !(at_rest || shown)) return {};
    status.emplace();
    status->changed_by = front_changed_by(now);
    if (!status->changed_by.empty() && !shown) return {};
    const FrontRequest request = front_request(now, sets_of(session, now), session.disk.changes());
    if (at_rest) session.front.want(request);
    const std::shared_ptr<const FrontFound> found = session.front.found(request);
    status->working = session.front.working();
    if (!found) return {};
    status->error = found->error;
    if (!found->error.empty()) return {};
    status->measured = true;
    status->matches = meets(found->fidelity, small_targets);
    status->psnr_db = found->fidelity.psnr_db;
    status->ssim = found->fidelity.ssim;
    status->light = found->fidelity.flux.frame;
    return found;
}

/// The view's part of what the display shows, without what it is compared with; top row first.
Image view_pixels(Session& session, unsigned texture) {
    DisplaySettings shown = session.displayed;
    shown.b = texture;
    Image view = session.display.read_compared(shown, session.viewport_px.x, session.viewport_px.y).a;
    for (std::int64_t y = 0; y < view.height / 2; ++y)
        std::swap_ranges(view.at(0, y), view.at(0, y) + view.width * 4, view.at(0, view.height - 1 - y));
    return view;
}

void fill_estimate(Session& session, double now) {
    if (session.view.render_open)
        session.estimate.want(session.jobs, session.view.render, session.document, now);
    else
        session.estimate = {};
    session.status.render_estimate = session.estimate.working() ? "Working it out" : session.estimate.text();
}

void fill_command(Session& session) {
    if (!session.view.render_open) return;
    const std::tuple source(session.document.revision(), session.document.file(), session.view.render);
    if (session.command_source == source) return;
    session.command_source = source;
    // A name is enough where every shell finds the program.
    const std::string program = has_program("astrosplat") ? "astrosplat" : own_program();
    const BatchCommand command = render_command(session.document, session.view.render, program);
    session.status.render_command = command.text;
    session.status.no_render_command = command.reason;
}

/// As the viewport shows that frame of the scene that is open.
FinishedRequest request_for(Session& session, const fs::path& file) {
    if (session.finished_header.first != file) session.finished_header = {file, read_frame_header(file)};
    const Scene& scene = session.document.scene();
    const std::optional<std::int64_t> number = session.finished_header.second.frame;
    const double frame = number ? static_cast<double>(*number) : session.view.frame;
    FinishedRequest request;
    request.file = file;
    request.view = display_view(session.view.display, scene.output.view);
    if (session.view.display == OutputParams::View::automatic) request.ocio = session.color.transform();
    request.exposure = scene_at(scene, frame).output.exposure;
    return request;
}

void show_finished_frame(Session& session) {
    FinishedFrame& shown = session.status.finished;
    const QueuedJob* const job =
        session.view.queue_open ? chosen_job(session.status, session.view.queue_job) : nullptr;
    if (!job || job->files.empty()) {
        shown = {};
        return session.finished.cancel();
    }
    const auto last = static_cast<int>(job->files.size()) - 1;
    const int index = session.view.queue_frame < 0 ? last : std::min(session.view.queue_frame, last);
    const FinishedRequest request = request_for(session, job->files[static_cast<std::size_t>(index)]);
    session.finished.want(request);
    const auto found = session.finished.found(request);
    if (!found) return;  // while it is read, the last one stays
    shown.error = found->error;
    if (!found->error.empty()) return;
    UploadedImage<FinishedView>& image = session.finished_image;
    image.show(found, &FinishedView::image);
    shown.texture = to_handle(image.texture());
    shown.aspect = image.aspect();
}

}  // namespace

bool show_rendered_frame(Session& session, const Rect& place, DisplaySettings& shown) {
    Status& status = session.status;
    UploadedImage<PackedImage>& image = session.rendered_image;
    status.rendered_frame.clear();
    status.missing_frame.clear();
    if (!wants_rendered(session)) {
        session.rendered.want({});
        image.clear();
        return false;
    }
    const std::optional<FrameFiles> files = frame_files(session.document.scene());
    session.rendered.want(files ? files_ahead(session, *files) : std::vector<fs::path>());
    const fs::path file = files ? files->of(session.view.frame) : "frame";
    std::error_code ignored;
    if (!files || !fs::exists(file, ignored)) {
        status.missing_frame = file.filename().string();
        image.clear();
        return false;
    }
    const std::shared_ptr<const PackedImage> found = session.rendered.found(file);
    if (found && !found->error.empty()) {
        status.missing_frame = file.filename().string();
        return false;
    }
    if (found) image.show(found, to_image);
    if (!image.found()) return false;  // the first one is being read
    status.rendered_frame = file.filename().string();
    show_alone(image.texture(), !image.found()->is_light(), image.size_px(), place, shown);
    return true;
}

bool show_movie(Session& session, DisplaySettings& shown) {
    fs::path& movie = session.view.movie;
    session.status.played_movie.clear();
    try {
        session.movie.want(movie, session.viewport_px);
    } catch (const OutputError& error) {
        say(session.status, error.what(), true);
        movie.clear();
    }
    const UploadedImage<PackedImage>& image = session.movie.image();
    if (movie.empty() || !image.found()) return false;
    session.status.played_movie = movie.filename().string();
    const glm::vec2 port(session.viewport_px);
    show_alone(image.texture(), true, image.size_px(), {0, 0, port.x, port.y}, shown);
    return true;
}

void show_front(Session& session, const Scene& now, DisplaySettings& shown) {
    const std::shared_ptr<const FrontFound> found = check_front(session, now);
    if (!found || session.view.compare != CompareMode::front) return;
    UploadedImage<FrontFound>& image = session.front_difference;
    image.show(found, &FrontFound::difference);
    const glm::vec2 port(session.viewport_px);
    show_alone(image.texture(), true, image.size_px(), {0, 0, port.x, port.y}, shown);
    shown.width = std::round(shown.width);
    shown.height = std::round(shown.height);
    shown.x = std::round(0.5f * (port.x - shown.width));
    shown.y = std::round(0.5f * (port.y - shown.height));
}

void show_preparation(Session& session) {
    std::optional<PrepareStatus>& status = session.status.preparation;
    const std::vector<LayerParams>& layers = session.document.scene().layers;
    status.reset();
    if (!session.view.preparation_open || session.view.layer >= layers.size())
        return session.preparation.cancel();
    const auto request = prepare_request(layers[session.view.layer], session.disk.changes());
    if (!request) return session.preparation.cancel();
    session.preparation.want(*request);
    status.emplace();
    status->working = session.preparation.working();
    UploadedImage<PreparedView>&before = session.preparation_before, &after = session.preparation_after;
    const auto found = session.preparation.found(*request);
    if (found) status->error = found->error;
    if (found && found->error.empty()) {
        before.show(found, &PreparedView::before);
        after.show(found, &PreparedView::after);
    }
    // While another is worked out, the last one stays.
    if (!after.found() || after.found()->files != request->files || !status->error.empty()) return;
    status->before = to_handle(before.texture());
    status->after = to_handle(after.texture());
    status->aspect = after.aspect();
    status->stars = after.found()->stars;
}

/// Textures are made of what is seen alone: a folder may hold more pictures than a GPU has memory for.
void show_thumbnails(Session& session) {
    const std::vector<ListedPicture>& seen = session.view.listed_pictures;
    std::map<ListedPicture, ListedThumbnail>& shown = session.status.thumbnails;
    session.thumbnails.want(seen);
    const auto is_gone = [&](const auto& entry) {
        return std::ranges::find(seen, entry.first) == seen.end();
    };
    std::erase_if(shown, is_gone);
    std::erase_if(session.thumbnail_textures, is_gone);
    for (const ListedPicture& picture : seen) {
        if (shown.count(picture)) continue;
        const std::shared_ptr<const PackedImage> found = session.thumbnails.found(picture);
        if (!found) continue;
        ListedThumbnail& thumbnail = shown[picture];
        if (!found->error.empty()) continue;
        ImageTexture& texture = session.thumbnail_textures[picture];
        texture.upload_smooth(to_image(*found));
        thumbnail = {to_handle(texture.handle()), found->file_width, found->file_height};
    }
}

void show_kinds(Session& session) {
    std::map<SkyObject, KindStatus>& shown = session.status.kinds;
    const std::optional<PictureStart>& start = session.view.start;
    if (!start || (session.kinds_of && *session.kinds_of != start->picture)) {
        shown.clear();
        session.kind_textures.clear();
        session.kinds_of.reset();
    }
    if (!start || session.starts.wanted()) return session.kind_views.want({});
    session.kinds_of = start->picture;
    // The body itself comes first, unless one could as well look about meanwhile.
    constexpr double long_s = 10.0;
    const bool is_long = std::ranges::any_of(
        session.status.layers, [](const LayerStatus& layer) { return layer.making.seconds >= long_s; });
    std::vector<KindKey> keys;
    for (const SkyObject object : kinds_by_share(*start))
        if (!shown.count(object)) keys.push_back({start->picture, object});
    session.kind_views.want(session.sets.loader().sets_there() || is_long ? keys : std::vector<KindKey>());
    for (const KindKey& key : keys) {
        const std::shared_ptr<const KindView> found = session.kind_views.found(key);
        if (!found) continue;
        KindStatus& kind = shown[key.object];
        kind.error = found->error;
        if (!kind.error.empty()) continue;
        ImageTexture& texture = session.kind_textures[key.object];
        texture.upload_smooth(found->image);
        kind.texture = to_handle(texture.handle());
    }
}

void show_scopes(Session& session) {
    const ViewState& view = session.view;
    std::array<void*, scope_count>& shown = session.status.scopes;
    if (!view.scopes_open) {
        shown = {};
        session.scopes_of = {};
        return;
    }
    const std::pair now(session.display.version(), view.scopes);
    if (std::exchange(session.scopes_of, now) == now) return;
    const ScreenPoints points = session.display.points();
    for (std::size_t i = 0; i < scope_count; ++i) {
        shown[i] = nullptr;
        if (!view.scopes[i] || points.rgba.empty()) continue;
        const auto scope = static_cast<Scope>(i);
        session.scope_textures[i].upload_smooth(scope_picture(scope, count_points(scope, points)));
        shown[i] = to_handle(session.scope_textures[i].handle());
    }
}

void begin_alignment(Session& session) {
    const ReferenceParams* reference = seen_reference(session.document.scene(), session.status);
    const Image* picture = session.comparison.reference().picture();
    if (!reference || !picture) throw InputError("the reference has not been read yet");
    AlignmentRequest request;
    request.view = view_pixels(session, session.comparison.reference().texture());
    if (request.view.pixels.empty()) throw InputError("there is no frame to align to yet");
    request.picture = *picture;
    request.frame = frame_on_screen(frame_in_viewport(session));
    request.frame.middle -= glm::dvec2(std::max(0.0f, std::round(session.displayed.x)),
                                       std::max(0.0f, std::round(session.displayed.y)));
    request.reference = *reference;
    request.camera = session.request.scene.camera;
    session.alignment.begin(std::move(request));
    say(session.status, "Aligning the reference to this view");
}

void take_alignment(Session& session) {
    const std::shared_ptr<const AlignmentFound> found = session.alignment.take();
    if (!found) return;
    if (!found->error.empty()) return say(session.status, found->error, true);
    const AlignmentRequest& request = session.alignment.request();
    const std::string name = request.reference.file.filename().string();
    if (!found->reference)
        return say(session.status, "Nothing in the view is like " + name + ": it stays where it is", true);
    const ReferenceParams* now = seen_reference(session.document.scene(), session.status);
    if (!now || !(*now == request.reference) || !(session.request.scene.camera == request.camera))
        return say(session.status, "Not aligned: the view or the reference has been changed since", true);
    const std::size_t index = session.status.reference->index;
    session.document.edit("Align reference",
                          [&](Scene& scene) { scene.references[index] = *found->reference; });
    show_reference(session.view);
    say(session.status, fmt::format("Aligned {}, likeness {:.2f}", name, found->likeness));
}

void show_renderings(Session& session, double now) {
    const auto news = session.jobs.poll(now);
    if (news) say(session.status, news->text, news->error);
    session.status.jobs = session.jobs.jobs();
    fill_command(session);
    fill_estimate(session, now);
    show_finished_frame(session);
}

}  // namespace astrosplat
