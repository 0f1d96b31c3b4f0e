// Cards: what a picture was taken for, over the frame; the jobs of the queue at the left, the newest last,
// with the finished frames of the chosen one at the right; and a row of snapshots that scrolls sideways, with
// the button that takes another.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "core/memory.h"
#include "edit/picture_start.h"
#include "gui/parts.h"

namespace astrosplat {
namespace {

using JobState = QueuedJob::State;
constexpr float queue_width = 940, queue_height = 520, list_width = 400, job_height = 76, card_gap = 8;

std::string state_text(const QueuedJob& job) {
    if (job.state == JobState::waiting)
        return job.held_by == 0 ? "Waits" : "Stopped by what failed: try that again, or take it off";
    if (job.state == JobState::done) return job.kept ? "Kept: it was made of these very frames" : "Done";
    if (job.state == JobState::cancelled) return "Cancelled; finished files are kept";
    const bool is_timed = job.state == JobState::running && job.seconds_left;
    return is_timed ? fmt::format("{}, {} left", job.text, duration_text(*job.seconds_left)) : job.text;
}

ImU32 state_color(JobState state) {
    return state == JobState::failed ? color::error : state == JobState::done ? color::good : color::dim;
}

void draw_card_text(const QueuedJob& job, ImVec2 corner, float width) {
    const float x = corner.x + px(card_gap), room = width - 2 * px(card_gap);
    draw_text({x, corner.y + px(6)}, color::text, fitting(job.title, room));
    ImGui::PushFont(small_font());
    draw_text({x, corner.y + px(28)}, color::dim, fitting(job.target.string(), room));
    draw_text({x, corner.y + px(46)}, state_color(job.state), fitting(state_text(job), room - px(64)));
    ImGui::PopFont();
    if (job.state != JobState::running && job.state != JobState::submitted) return;
    progress_bar({x, corner.y + px(job_height) - px(8)}, room, job.progress);
}

void card_button(GuiFrame& frame, const QueuedJob& job, ImVec2 corner, float width) {
    const bool ends =
        job.state == JobState::running || job.state == JobState::waiting || job.state == JobState::submitted;
    const float side = px(22);
    ImGui::SetCursorScreenPos({corner.x + width - side - px(card_gap), corner.y + px(42)});
    if (icon_button("end", Icon::cross, {side, side}, px(10), color::dim,
                    ends ? "Cancel" : "Take off the list"))
        request(frame, ends ? Command::Kind::cancel_job : Command::Kind::remove_job, job.number);
    note_item(frame, fmt::format("queue/end {}", job.number));
}

void draw_job_card(GuiFrame& frame, const QueuedJob& job, bool chosen) {
    ImGui::PushID(static_cast<int>(job.number));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    if (ImGui::InvisibleButton("card", {width, px(job_height)})) {
        frame.view.queue_job = job.number;
        frame.view.queue_frame = -1;
    }
    ImGui::SetItemAllowOverlap();
    note_item(frame, fmt::format("queue/job {}", job.number));
    const ImVec2 below = ImGui::GetCursorScreenPos();
    fill_rect(corner, {corner.x + width, corner.y + px(job_height)}, chosen ? color::selection : color::field,
              px(4));
    draw_card_text(job, corner, width);
    card_button(frame, job, corner, width);
    ImGui::SetCursorScreenPos(below);
    ImGui::PopID();
}

void draw_list(GuiFrame& frame, const QueuedJob* chosen) {
    ImGui::BeginChild("jobs", {px(list_width), -px(44)}, false, ImGuiWindowFlags_NavFlattened);
    if (frame.status.jobs.empty())
        ImGui::TextColored(color4(color::dim), "Nothing was rendered yet: Render > Frames...");
    for (const QueuedJob& job : frame.status.jobs) draw_job_card(frame, job, &job == chosen);
    ImGui::EndChild();
}

// At the rate of the scene, round and round.
void play(ViewState& view, int count, double fps) {
    if (!view.queue_playing || count < 2) return;
    view.queue_frame = static_cast<int>(std::fmod(ImGui::GetTime() * fps, static_cast<double>(count)));
}

// Why it failed, whole, which a card has no room for.
void draw_failure(GuiFrame& frame, const QueuedJob& job) {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextColored(color4(color::error), "%s", job.text.c_str());
    ImGui::PopTextWrapPos();
    if (dialog_button("Try again", false, 84)) request(frame, Command::Kind::retry_job, job.number);
    tooltip("Finished frames stay");
    note_item(frame, "queue/Try again");
    ImGui::Dummy({0, px(card_gap)});
}

void draw_frames(GuiFrame& frame, const QueuedJob& job) {
    ViewState& view = frame.view;
    const int count = static_cast<int>(job.files.size());
    const float width = ImGui::GetContentRegionAvail().x;
    const FinishedFrame& finished = frame.status.finished;
    if (job.state == JobState::failed) draw_failure(frame, job);
    if (job.is_movie && job.state == JobState::done) {
        if (dialog_button("Play", false, 84)) {
            view.movie = job.target;
            view.queue_open = view.queue_playing = false;
        }
        tooltip("In the view, over and over; Esc or a click there ends it");
        return note_item(frame, "queue/Play movie");
    }
    const ImVec2 size{width, ImGui::GetContentRegionAvail().y - px(76)};
    image_box({ImGui::GetCursorScreenPos(), size}, finished.texture, finished.aspect, 3);
    ImGui::Dummy(size);
    if (!finished.error.empty()) ImGui::TextColored(color4(color::error), "%s", finished.error.c_str());
    const std::string none = job.is_splats ? job.text : "No frame is finished yet.";
    if (count == 0) return ImGui::TextColored(color4(color::dim), "%s", none.c_str());
    play(view, count, frame.document.scene().output.fps);
    int shown = view.queue_frame < 0 ? count - 1 : std::min(view.queue_frame, count - 1);
    if (dialog_button(view.queue_playing ? "Pause" : "Play", false, 64))
        view.queue_playing = !view.queue_playing;
    note_item(frame, "queue/play");
    ImGui::SameLine(0, px(card_gap));
    ImGui::SetNextItemWidth(width - px(64) - px(card_gap));
    const bool moved =
        ImGui::SliderInt("##frame", &shown, 0, std::max(1, count - 1), "", ImGuiSliderFlags_AlwaysClamp);
    if (moved || ImGui::IsItemActivated()) {  // a click on the frame shown stops there
        view.queue_frame = std::min(shown, count - 1);
        view.queue_playing = false;
    }
    note_item(frame, "queue/frame");
    ImGui::TextColored(color4(color::dim), "%s",
                       job.files[static_cast<std::size_t>(shown)].filename().c_str());
}

}  // namespace

std::string duration_text(double seconds) {
    const auto whole = static_cast<std::int64_t>(std::ceil(std::max(0.0, seconds)));
    const std::int64_t hours = whole / 3600, minutes = whole / 60 % 60;
    return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60)
                     : fmt::format("{}:{:02}", minutes, whole % 60);
}

std::string making_text(const Making& making, double share) {
    return fmt::format("{}, {}, {}", splat_count(std::int64_t(share * double(making.splats))),
                       human_bytes(share * double(making.bytes)), duration_text(share * making.seconds));
}

void draw_queue(GuiFrame& frame) {
    bool& open = frame.view.queue_open;
    if (!begin_dialog("queue", "Render queue", open, queue_width, queue_height)) return;
    const QueuedJob* const chosen = chosen_job(frame.status, frame.view.queue_job);
    draw_list(frame, chosen);
    ImGui::SameLine(0, px(12));
    ImGui::BeginChild("frames", {0, -px(44)}, false,
                      ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NavFlattened);
    if (chosen) draw_frames(frame, *chosen);
    ImGui::EndChild();
    ImGui::SetCursorPosY(ImGui::GetWindowHeight() - px(44));
    const int button = dialog_buttons(frame, "queue", {"Show in folder", "Close"}, 1);
    if (button == 0 && chosen) request_path(frame, Command::Kind::open_folder, chosen->target.parent_path());
    if (button == 1) open = frame.view.queue_playing = false;
    end_dialog(!open);
}

namespace {

constexpr float start_width = 430, start_inset = 12, start_padding = 12;

/// Beside the last one where there is room, else in a new line.
bool start_button(GuiFrame& frame, const char* name, const std::string& label, bool chosen,
                  const char* hint) {
    const float width = ImGui::CalcTextSize(label.c_str()).x + 2 * px(8);
    ImGui::SameLine(0, px(6));
    if (ImGui::GetContentRegionAvail().x < width) ImGui::NewLine();
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, color4(color::selection));
    const bool clicked = ImGui::Button(label.c_str(), {width, px(24)});
    if (chosen) ImGui::PopStyleColor();
    tooltip(hint);
    note_item(frame, std::string("start/") + name);
    return clicked && !chosen;
}

/// "Taken for a galaxy (72 %), seen at 62 degrees"; while it is made, as what.
std::string start_title(const GuiFrame& frame, const PictureStart& start) {
    if (frame.status.starting) return starting_text(*frame.status.starting);
    const double sure = share_of(start, start.object);
    std::string title = std::string("Taken for ") + kind_words(start.object).with_article;
    if (!start.as && sure < 0.9) title += fmt::format(" ({:.0f} %)", 100.0 * sure);
    const std::string seen =
        frame.document.edited() ? seen_in_words(frame.document.scene(), start.object) : start.seen;
    return seen.empty() ? title : title + ", " + seen;
}

/// True: closed.
bool start_head(GuiFrame& frame, const std::string& title, float right) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::TextUnformatted(fitting(title, right - px(26) - corner.x).c_str());
    const ImVec2 below = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos({right - px(22), corner.y - px(3)});
    const bool closed = icon_button("close", Icon::cross, {px(22), px(22)}, px(9), color::dim, "Close");
    note_item(frame, "start/close");
    ImGui::SetCursorScreenPos(below);
    return closed;
}

void start_reason(const std::string& text, bool compact) {
    ImGui::PushFont(small_font());
    const float room = ImGui::GetContentRegionAvail().x;
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + room);
    ImGui::TextColored(color4(color::dim), "%s", compact ? fitting(text, room).c_str() : text.c_str());
    ImGui::PopTextWrapPos();
    if (compact) tooltip(text.c_str());
    ImGui::PopFont();
}

/// A kind as it would look from aside, `size` px, with its name and share below. True when clicked.
bool kind_button(GuiFrame& frame, const PictureStart& start, SkyObject object, ImVec2 size) {
    const ObjectWords& words = kind_words(object);
    const bool chosen = object == start.object;
    const auto found = frame.status.kinds.find(object);
    const KindStatus kind = found == frame.status.kinds.end() ? KindStatus{} : found->second;
    const float line = px(15);
    const ImVec2 corner = ImGui::GetCursorScreenPos(), whole{size.x, size.y + 2 * line};
    const bool clicked = ImGui::InvisibleButton(words.button, whole);
    note_item(frame, std::string("start/") + words.button);
    const bool hovered = ImGui::IsItemHovered();
    tooltip(chosen ? "It is taken for that" : "Makes the scene again as that");
    const Rect picture{corner, size};
    image_box(picture, kind.texture, size.x / size.y, 3);
    ImGui::PushFont(small_font());
    if (!kind.texture) {
        const char* const why = kind.error.empty() ? "..." : "no preview";
        const ImVec2 room = ImGui::CalcTextSize(why);
        draw_text({picture.middle().x - room.x * 0.5f, picture.middle().y - room.y * 0.5f}, color::dim, why);
    }
    outline_rect(picture,
                 chosen    ? color::accent
                 : hovered ? color::text
                           : color::hover,
                 px(3), px(chosen ? 2.0f : 1.0f));
    const double share = share_of(start, object);
    const std::string sure = share >= 0.01 ? fmt::format("{:.0f} %", 100.0 * share) : "unlikely";
    draw_text({corner.x, picture.end().y + px(2)}, chosen || hovered ? color::text : color::dim,
              fitting(words.button, size.x));
    draw_text({corner.x, picture.end().y + line}, color::dim, chosen && start.as ? "as you say" : sure);
    ImGui::PopFont();
    return clicked && !chosen;
}

/// What it is taken for and what else it may be, the likeliest first, in a row that scrolls.
void start_kinds(GuiFrame& frame, const PictureStart& start, bool compact) {
    const ImVec2 size = compact ? ImVec2(px(80), px(50)) : ImVec2(px(112), px(70));
    const float bar = ImGui::GetStyle().ScrollbarSize;
    ImGui::BeginChild("kinds", {0, size.y + px(32) + bar}, false,
                      ImGuiWindowFlags_HorizontalScrollbar | ImGuiWindowFlags_NoScrollWithMouse |
                          ImGuiWindowFlags_NavFlattened);
    if (ImGui::IsWindowHovered() && ImGui::GetIO().MouseWheel != 0.0f)
        ImGui::SetScrollX(ImGui::GetScrollX() - ImGui::GetIO().MouseWheel * size.x);
    for (const SkyObject object : kinds_by_share(start)) {
        if (kind_button(frame, start, object, size))
            request_text(frame, Command::Kind::start_again, std::string(name_of(object)));
        ImGui::SameLine(0, px(6));
    }
    ImGui::EndChild();
}

void start_choices(GuiFrame& frame, const PictureStart& start) {
    row_text("Stars", px(24), color::dim);
    if (start_button(frame, "Keep", "Keep", !start.parted, "They are dots in the depth of the picture"))
        request_text(frame, Command::Kind::start_again, "keep");
    if (start_button(frame, "Part", "Part", start.parted,
                     "They become a layer of their own, and a table beside the picture"))
        request_text(frame, Command::Kind::start_again, "part");
    const bool film = start.film;
    if (start_button(frame, "Make a film", film ? "No film" : "Make a film", false,
                     film ? "Without the camera's move"
                          : "A camera move of ten seconds, with detail where it comes close"))
        request_text(frame, Command::Kind::start_again, film ? "still" : "film");
}

/// What a large picture will take, while it is made; and the same at half its width and height.
void start_size(GuiFrame& frame, const PictureStart& start) {
    constexpr double much_seconds = 30.0, much_bytes = 2147483648.0;
    const auto layer =
        std::ranges::find_if(frame.status.layers, [](const LayerStatus& l) { return l.making.splats > 0; });
    const Making making = layer == frame.status.layers.end() ? Making() : layer->making;
    const bool half = start.most_splats > 0;
    if (!half && making.seconds < much_seconds && double(making.bytes) < much_bytes) return;
    const double now = std::max(1.0, double(making.splats)), whole = double(making.whole_splats) / now;
    const auto label = [&](const char* name, double share) {
        return making.splats > 0 ? fmt::format("{}: {}", name, making_text(making, share))
                                 : std::string(name);
    };
    row_text("Size", px(24), color::dim);
    if (start_button(frame, "Whole", label("Whole", whole), !half, "Every pixel of the picture"))
        request_text(frame, Command::Kind::start_again, "whole");
    if (start_button(frame, "Half size", label("Half size", half ? 1.0 : 0.25), half,
                     "The picture at half its width and height: a quarter of the splats, memory and time"))
        request_text(frame, Command::Kind::start_again, fmt::format("splats {}", making.splats / 4));
}

}  // namespace

std::string starting_text(const StartingStatus& starting) {
    const std::string name = starting.picture.filename().string();
    return starting.choice.empty() ? "Looking at " + name : choice_in_words(starting.choice) + ": it is made";
}

void draw_start_card(GuiFrame& frame, const Rect& viewport) {
    std::optional<PictureStart>& start = frame.view.start;
    if (start && !only_lies_otherwise(frame.document)) start.reset();
    const std::optional<StartingStatus>& starting = frame.status.starting;
    const float width = std::min(px(start_width), viewport.width - 2 * px(start_inset));
    if (!(start || starting) || width < px(200)) return;
    const bool compact = viewport.height < px(430);
    const float most = viewport.height * 0.62f;
    float& height = *ImGui::GetStateStorage()->GetFloatRef(ImGui::GetID("start card"), px(190));
    ImGui::SetCursorScreenPos({viewport.x + px(start_inset), viewport.y + px(start_inset)});
    // A picture that is opened has no kinds yet.
    const bool opens = starting && starting->choice.empty();
    const std::optional<PictureStart> shown = opens ? std::nullopt : start;
    ImGui::PushStyleColor(ImGuiCol_ChildBg, color4(color::with_opacity(color::window, 0.92f)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(start_padding), px(start_padding)));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(6), px(6)));
    ImGui::BeginChild(
        "start card", {width, std::min(height, most)}, false,
        (height > most ? 0 : ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse) |
            ImGuiWindowFlags_AlwaysUseWindowPadding);
    enter_part("start card");
    const float right = ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x + px(4);
    if (!shown) {
        ImGui::TextUnformatted(
            fitting(starting_text(*starting), right - ImGui::GetCursorScreenPos().x).c_str());
        start_reason("to see what it shows and how that lies. Esc cancels.", compact);
    } else if (start_head(frame, start_title(frame, *shown), right)) {
        start.reset();
        if (starting) request(frame, Command::Kind::cancel_start);
    }
    if (starting) {
        progress_bar(ImGui::GetCursorScreenPos(), ImGui::GetContentRegionAvail().x, starting->progress);
        ImGui::Dummy({0, px(4)});
    }
    if (shown) {
        if (!starting) start_reason("because " + shown->because, compact);
        start_kinds(frame, *shown, compact);
        start_choices(frame, *shown);
        start_size(frame, *shown);
    }
    height = ImGui::GetCursorPosY() - px(6) + px(start_padding);
    ImGui::EndChild();
    ImGui::PopStyleVar(2);
    ImGui::PopStyleColor();
}

namespace {

constexpr float thumbnail_width = 128, thumbnail_height = 72, card_height = 108, margin = 8;

std::string snapshot_line(const Snapshot& snapshot) {
    const std::string splats = short_count(snapshot.splats);
    return snapshot.seconds > 0 ? fmt::format("{}, {:.1f} s", splats, snapshot.seconds)
                                : splats + ", preview";
}

// In place of the name: Enter takes what was typed, Escape or a click elsewhere drops it.
void name_entry(GuiFrame& frame, std::size_t index, ImVec2 corner) {
    ViewState& view = frame.view;
    ImGui::SetCursorScreenPos(corner);
    ImGui::SetNextItemWidth(px(thumbnail_width));
    if (!any_popup() && !ImGui::IsAnyItemActive()) ImGui::SetKeyboardFocusHere();
    const bool entered = ImGui::InputText(
        "##name", &view.typed_name, ImGuiInputTextFlags_AutoSelectAll | ImGuiInputTextFlags_EnterReturnsTrue);
    note_item(frame, "snapshot name");
    if (entered && !view.typed_name.empty())
        request_text(frame, Command::Kind::rename_snapshot, view.typed_name, index);
    if (ImGui::IsItemDeactivated()) view.renamed_snapshot = -1;
}

void card_menu(GuiFrame& frame, std::size_t index) {
    ImGui::OpenPopupOnItemClick("card menu");
    if (!begin_menu_popup("card menu")) return;
    const auto entry = [&](const char* label) { return noted_menu_item(frame, "snapshot", label); };
    if (entry("Show")) request(frame, Command::Kind::show_snapshot, index);
    if (entry("Compare as B")) request(frame, Command::Kind::compare_snapshot, index);
    if (entry("Restore")) request(frame, Command::Kind::restore_snapshot, index);
    ImGui::Separator();
    if (entry("Rename")) {
        frame.view.renamed_snapshot = static_cast<int>(index);
        frame.view.typed_name = frame.status.snapshots[index].name;
    }
    if (entry("Delete")) request(frame, Command::Kind::delete_snapshot, index);
    end_menu_popup();
}

void draw_card(GuiFrame& frame, std::size_t index) {
    const Snapshot& snapshot = frame.status.snapshots[index];
    ImGui::PushID(static_cast<int>(index));
    ImGui::BeginGroup();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    if (ImGui::InvisibleButton("card", {px(thumbnail_width), px(card_height)}))
        request(frame, Command::Kind::compare_snapshot, index);
    note_item(frame, fmt::format("snapshot {}", index));
    const bool hovered = ImGui::IsItemHovered(), is_b = frame.status.b_snapshot == static_cast<int>(index);
    tooltip("Click: compare as B. Right click: show, restore, rename, delete");
    ImGui::SetItemAllowOverlap();
    const Rect area(corner, {px(thumbnail_width), px(thumbnail_height)});
    image_box(area, snapshot.thumbnail, snapshot.aspect, 3);
    const ImVec2 end = area.end();
    if (is_b || hovered) outline_rect(area, is_b ? color::accent : color::dim, px(3), px(1.5f));
    ImGui::PushFont(small_font());
    const bool is_renamed = frame.view.renamed_snapshot == static_cast<int>(index);
    const std::string name = (is_b ? "B  " : "") + snapshot.name;
    if (!is_renamed)
        draw_text({corner.x, end.y + px(3)}, is_b ? color::accent : color::text,
                  fitting(name, px(thumbnail_width)));
    draw_text({corner.x, end.y + px(18)}, color::dim, snapshot_line(snapshot));
    ImGui::PopFont();
    card_menu(frame, index);
    if (is_renamed) name_entry(frame, index, {corner.x, end.y + px(2)});
    ImGui::EndGroup();
    ImGui::PopID();
}

void draw_take_button(GuiFrame& frame) {
    const ImVec2 corner = ImGui::GetCursorScreenPos(), size{px(72), px(thumbnail_height)};
    if (icon_button("take snapshot", Icon::plus, size, px(14), color::dim,
                    "Keep the look and the view as they are now"))
        request(frame, Command::Kind::take_snapshot);
    note_item(frame, "take snapshot");
    outline_rect({corner, size}, color::hover, px(3));
}

}  // namespace

void draw_snapshots(GuiFrame& frame, const Rect& area) {
    if (!begin_part("snapshots", area, ImGuiWindowFlags_HorizontalScrollbar)) return;
    ImGui::SetCursorPos({px(margin), px(margin)});
    draw_take_button(frame);
    for (std::size_t i = 0; i < frame.status.snapshots.size(); ++i) {
        ImGui::SameLine(0, px(margin));
        draw_card(frame, i);
    }
    if (frame.status.snapshots.empty()) {
        ImGui::SameLine(0, px(12));
        row_text("Snapshots keep a look with its thumbnail, to compare with and to come back to.",
                 px(thumbnail_height), color::dim);
    }
    ImGui::EndChild();
}

}  // namespace astrosplat
