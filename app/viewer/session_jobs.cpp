// Renderings to files: the jobs, the command that the dialog shows, and a finished frame.

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "edit/command_lines.h"
#include "scene/animate.h"
#include "viewer/session_parts.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

void fill_command(Session& session) {
    if (!session.view.render_open) return;
    const CommandSource source{session.document.revision(), session.document.file(), session.view.render};
    if (session.command_source == source) return;
    session.command_source = source;
    // A name is enough where every shell finds the program.
    const std::string program = has_program("astrosplat") ? "astrosplat" : own_program();
    const BatchCommand command = render_command(session.document, session.view.render, program);
    session.status.render_command = command.text;
    session.status.no_render_command = command.reason;
}

const QueuedJob* job_looked_at(const Session& session) {
    const std::vector<QueuedJob>& jobs = session.status.jobs;
    const auto chosen = std::ranges::find(jobs, session.view.queue_job, &QueuedJob::number);
    if (chosen != jobs.end()) return &*chosen;
    return jobs.empty() ? nullptr : &jobs.back();
}

/// As the viewport shows that frame of the scene that is open.
FinishedRequest request_for(Session& session, const fs::path& file) {
    if (session.finished_header.first != file) session.finished_header = {file, read_frame_header(file)};
    const Scene& scene = session.document.scene();
    const std::optional<std::int64_t> told = session.finished_header.second.frame;
    const double frame = told ? static_cast<double>(*told) : session.view.frame;
    FinishedRequest request;
    request.file = file;
    request.view = display_view(session.view.display, scene.output.view);
    if (session.view.display == OutputParams::View::automatic) request.ocio = session.color.transform();
    request.exposure = scene_at(scene, frame).output.exposure;
    return request;
}

void show_finished_frame(Session& session) {
    FinishedFrame& shown = session.status.finished;
    const QueuedJob* const job = session.view.queue_open ? job_looked_at(session) : nullptr;
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
    ShownPicture<FinishedView>& picture = session.finished_picture;
    picture.show(found, [](const FinishedView& view) -> const Image& { return view.image; });
    shown.texture = to_handle(picture.texture());
    shown.aspect = picture.aspect();
}

}  // namespace

void show_renderings(Session& session, double now) {
    const auto news = session.jobs.poll(now);
    if (news) say(session.status, news->text, news->error);
    session.status.jobs = session.jobs.jobs();
    fill_command(session);
    show_finished_frame(session);
}

}  // namespace astrosplat
