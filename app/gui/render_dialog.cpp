// One row a value, the label at the left; what is wrong is said where the button would be pressed.
#include "gui/parts.h"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include "core/error.h"
#include "core/memory.h"
#include "scene/frames.h"

namespace astrosplat {
namespace {

constexpr float render_width = 680, label_width = 92, side_width = 92, row_gap = 8, field_height = 26,
                command_height = 66;

void label(const char* text) {
    ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, color::dim);
    ImGui::TextUnformatted(text);
    ImGui::PopStyleColor();
    ImGui::SameLine(px(label_width));
}

// True when it changed `text`.
bool text_field(GuiFrame& frame, const char* name, std::string& text, float width) {
    ImGui::SetNextItemWidth(width);
    const bool changed = ImGui::InputText(fmt::format("##{}", name).c_str(), &text);
    note_item(frame, std::string("render/") + name);
    return changed;
}

void side_field(GuiFrame& frame, const char* name, std::int64_t& side) {
    int value = static_cast<int>(std::min<std::int64_t>(side, 65536));
    ImGui::SetNextItemWidth(px(84));
    if (ImGui::InputInt(fmt::format("##{}", name).c_str(), &value, 0)) side = value;
    note_item(frame, std::string("render/") + name);
}

void kind_row(GuiFrame& frame) {
    RenderTask& render = frame.view.render;
    label("Render");
    const int clicked = segmented(
        frame, "render",
        {{"Frame", "The frame that is seen"},
         {"Frames", "Numbered files of the scene's frames, or of others"},
         {"Movie", frame.status.has_ffmpeg ? "A film of them" : "Needs ffmpeg, which is not installed"},
         {"Splats", "The splats themselves, for other programs"}},
        static_cast<int>(render.kind), field_height);
    if (clicked < 0 || (clicked == 2 && !frame.status.has_ffmpeg)) return;
    const auto kind = static_cast<RenderKind>(clicked);
    const RenderTask usual = kept_render(frame.view.renders, frame.document, kind, frame.view.frame);
    render.kind = kind;
    render.frames = usual.frames;
    render.name = usual.name;
}

std::string count_of_frames(const RenderTask& render) {
    try {
        const std::size_t count = parse_frames(render.frames, "frames").size();
        return count == 1 ? "1 frame" : fmt::format("{} frames", count);
    } catch (const InputError&) {
        return "such as 1-240, 1-240x10 or 1,5,9";
    }
}

void frames_row(GuiFrame& frame) {
    const bool splats = frame.view.render.kind == RenderKind::splats;
    label(splats ? "Frame" : "Frames");
    text_field(frame, "frames", frame.view.render.frames, px(160));
    ImGui::SameLine(0, px(row_gap));
    ImGui::TextColored(color4(color::dim), "%s",
                       splats ? "whose look they have" : count_of_frames(frame.view.render).c_str());
}

// A list whose button shows `chosen`; `rows` draws its entries while it is open.
template <class Rows>
void choice_list(GuiFrame& frame, const char* name, const std::string& chosen, float width,
                 const Rows& rows) {
    ImGui::SetNextItemWidth(width);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const bool open =
        ImGui::BeginCombo(fmt::format("##{}", name).c_str(), chosen.c_str(), ImGuiComboFlags_NoArrowButton);
    if (!open)  // an open list would have it drawn into its own window
        draw_icon(ImGui::GetWindowDrawList(), Icon::chevron_down,
                  {corner.x + width - px(12), corner.y + ImGui::GetFrameHeight() * 0.5f}, px(9), color::dim);
    if (open) {
        rows();
        close_on_escape();
        ImGui::EndCombo();
    }
    note_item(frame, std::string("render/") + name);
}

void layer_row(GuiFrame& frame) {
    std::string& layer = frame.view.render.layer;
    label("Layer");
    const char* const all = "All that are visible";
    choice_list(frame, "layer", layer.empty() ? all : layer, px(240), [&] {
        if (ImGui::Selectable(all, layer.empty())) layer.clear();
        for (const LayerParams& other : frame.document.scene().layers)
            if (ImGui::Selectable(other.name.c_str(), other.name == layer)) layer = other.name;
    });
}

// Of the layers that are written, as far as their looks keep them.
std::int64_t splats_to_write(const GuiFrame& frame) {
    const std::vector<LayerParams>& layers = frame.document.scene().layers;
    const RenderTask& task = frame.view.render;
    std::int64_t count = 0;
    for (std::size_t i = 0; i < std::min(layers.size(), frame.status.layers.size()); ++i) {
        const LayerStatus& layer = frame.status.layers[i];
        if (!task.layer.empty() ? layers[i].name != task.layer : !layers[i].visible) continue;
        count += is_own_format(task) || layer.kept < 0 ? layer.splats : layer.kept;
    }
    return count;
}

void most_row(GuiFrame& frame) {
    std::int64_t& most = frame.view.render.most_splats;
    label("At most");
    int value = static_cast<int>(std::min<std::int64_t>(most, 2'000'000'000));
    ImGui::SetNextItemWidth(px(120));
    if (ImGui::InputInt("##most", &value, 0)) most = std::max(0, value);
    tooltip("Splats are merged until so many are left; 0: none is");
    note_item(frame, "render/most");
    ImGui::SameLine(0, px(row_gap));
    const std::int64_t count = splats_to_write(frame);
    ImGui::TextColored(color4(color::dim), "%s",
                       count > 0 ? ("of about " + human_count(count, "splat")).c_str() : "splats");
}

void size_row(GuiFrame& frame) {
    RenderTask& render = frame.view.render;
    const OutputParams& output = frame.document.scene().output;
    label("Size");
    side_field(frame, "width", render.width);
    ImGui::SameLine(0, px(row_gap));
    ImGui::TextUnformatted("x");
    ImGui::SameLine(0, px(row_gap));
    side_field(frame, "height", render.height);
    for (const auto& [text, share] : {std::pair{"Scene", 1.0}, {"Half", 0.5}, {"Double", 2.0}}) {
        ImGui::SameLine(0, px(row_gap));
        if (dialog_button(text, false, 64)) {
            render.width = std::max<std::int64_t>(1, std::llround(share * static_cast<double>(output.width)));
            render.height =
                std::max<std::int64_t>(1, std::llround(share * static_cast<double>(output.height)));
        }
        note_item(frame, std::string("render/") + text);
    }
}

void folder_row(GuiFrame& frame) {
    RenderTask& render = frame.view.render;
    label("Folder");
    const float button = px(side_width);
    std::string folder = render.folder.string();
    if (text_field(frame, "folder", folder, ImGui::GetContentRegionAvail().x - button - px(row_gap)))
        render.folder = folder;
    tooltip(folder.c_str());
    ImGui::SameLine(0, px(row_gap));
    if (dialog_button("Choose...", false, side_width)) {
        frame.view.render_open = false;  // until the file dialog has the answer
        request(frame, Command::Kind::choose_target);
    }
    note_item(frame, "render/Choose...");
}

void name_row(GuiFrame& frame) {
    RenderTask& render = frame.view.render;
    label("Name");
    text_field(frame, "name", render.name, ImGui::GetContentRegionAvail().x - px(side_width) - px(row_gap));
    ImGui::SameLine(0, px(row_gap));
    const std::string ending = fs::path(render.name).extension().string();
    choice_list(frame, "format", ending, px(side_width), [&] {
        for (const std::string& other : render_endings(render.kind))
            if (ImGui::Selectable(other.c_str(), other == ending))
                render.name = with_ending(render.name, other);
    });
}

// Where the program finds a farm. Movies are written here, of frames rendered here.
void machine_row(GuiFrame& frame) {
    RenderTask& render = frame.view.render;
    if (!frame.status.has_slurm || render.kind == RenderKind::movie || render.kind == RenderKind::splats)
        return;
    label("On");
    const int clicked = segmented(frame, "render",
                                  {{"This machine", "In the background, one job after the other"},
                                   {"Slurm", "As tasks of the farm, which go on when the window is closed"}},
                                  render.by_slurm ? 1 : 0, field_height);
    if (clicked >= 0) render.by_slurm = clicked == 1;
    if (!render.by_slurm) return;
    const auto word = [](const char* text) {
        ImGui::SameLine(0, px(row_gap));
        ImGui::AlignTextToFramePadding();
        ImGui::TextColored(color4(color::dim), "%s", text);
        ImGui::SameLine(0, px(row_gap));
    };
    word("frames a task");
    side_field(frame, "chunk", render.chunk);
    word("partition");
    text_field(frame, "partition", render.partition, px(120));
    tooltip("A name of the cluster's, such as short; empty: its own choice");
}

void existing_row(GuiFrame& frame) {
    label("Existing");
    if (renders_by_slurm(frame.view.render))
        return ImGui::TextColored(color4(color::dim),
                                  "Finished frames of these settings stay, others are replaced");
    ExistingFrames& existing = frame.view.render.existing;
    if (frame.view.render.kind == RenderKind::splats) {
        const int chosen = segmented(frame, "render",
                                     {{"Replace", "A file of that name is replaced once this one is whole"},
                                      {"Stop", "Nothing is written where a file of that name is"}},
                                     existing == ExistingFrames::replace ? 0 : 1, field_height);
        if (chosen >= 0) existing = chosen == 0 ? ExistingFrames::replace : ExistingFrames::refuse;
        return;
    }
    const bool movie = frame.view.render.kind == RenderKind::movie;
    const int clicked = segmented(
        frame, "render",
        {{"Keep finished", movie ? "A movie of these very frames that is there already stays; another "
                                   "is replaced once this one is whole"
                                 : "Frames of these settings that are there already stay; "
                                   "others are replaced"},
         {"Render again", "All frames are rendered, whatever is there"},
         {"Stop", "Nothing is rendered where a file is in the way"}},
        static_cast<int>(existing), field_height);
    if (clicked >= 0) existing = static_cast<ExistingFrames>(clicked);
}

std::string problem(const GuiFrame& frame) {
    const RenderTask& render = frame.view.render;
    if (render.kind == RenderKind::movie && !frame.status.has_ffmpeg) return "a movie needs ffmpeg";
    return render_problem(render, frame.document.scene().camera);
}

void estimate_row(GuiFrame& frame) {
    label("Takes");
    const std::string& text = frame.status.render_estimate;
    const bool known = !text.empty() && problem(frame).empty();
    const std::string shown = known ? text : "Not known";
    ImGui::TextColored(color4(known ? color::text : color::dim), "%s",
                       fitting(shown, ImGui::GetContentRegionAvail().x).c_str());
    tooltip(
        (shown + "\nOn this machine, by a sample of the frames and splats, as --dry-run tells it").c_str());
    note_item(frame, "render/takes");
}

void command_row(GuiFrame& frame) {
    const Status& status = frame.status;
    const bool known = !status.render_command.empty();
    bool& open = frame.view.command_open;
    label("Command");
    if (dialog_button(open ? "Hide" : "Show", false, 64)) open = !open;
    tooltip("What does the same in a shell");
    note_item(frame, "render/command");
    if (!open) return;
    ImGui::Dummy({0, 0});
    ImGui::SameLine(px(label_width));
    const float button = px(side_width), room = ImGui::GetContentRegionAvail().x - button - px(row_gap);
    ImGui::BeginChild("command", {room, px(command_height)}, false);  // as high whatever it says
    ImGui::PushTextWrapPos(0.0f);
    ImGui::PushStyleColor(ImGuiCol_Text, color::dim);
    ImGui::TextUnformatted(known ? status.render_command.c_str() : status.no_render_command.c_str());
    ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();
    ImGui::EndChild();
    ImGui::SameLine(ImGui::GetContentRegionMax().x - button);
    ImGui::BeginDisabled(!known);
    if (dialog_button("Copy", false, side_width))
        request_text(frame, Command::Kind::copy_text, status.render_command);
    note_item(frame, "render/Copy");
    ImGui::EndDisabled();
}

}  // namespace

void open_render_dialog(const Document& document, ViewState& view, RenderKind kind) {
    view.render = kept_render(view.renders, document, kind, view.frame);
    view.render_open = true;
}

void draw_render_dialog(GuiFrame& frame) {
    bool& open = frame.view.render_open;
    if (!begin_dialog("render", "Render to files", open, render_width, 0)) return;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(row_gap), px(row_gap)));
    push_field_height(px(field_height));
    kind_row(frame);
    frames_row(frame);
    const bool splats = frame.view.render.kind == RenderKind::splats;
    if (splats) {
        layer_row(frame);
        most_row(frame);
    } else {
        size_row(frame);
    }
    folder_row(frame);
    name_row(frame);
    machine_row(frame);
    existing_row(frame);
    if (!splats) estimate_row(frame);
    command_row(frame);
    const std::string wrong = problem(frame);
    ImGui::TextColored(color4(color::error), "%s", fitting(wrong, ImGui::GetContentRegionAvail().x).c_str());
    if (!wrong.empty()) tooltip(wrong.c_str());
    ImGui::PopStyleVar(2);
    const char* const go = renders_by_slurm(frame.view.render) ? "Submit"
                           : running_job(frame.status)         ? "Add to the queue"
                           : splats                            ? "Export"
                                                               : "Render";
    const int button = dialog_buttons(frame, "render", {"Cancel", go}, 0);
    const bool render = button == 1 && wrong.empty();
    if (render) request(frame, Command::Kind::render);
    if (render || button == 0) open = false;  // it is already while a folder is chosen
    end_dialog(!open);
}

}  // namespace astrosplat
