// Colours, spacing and fonts into ImGui's style and font atlas; shared controls; icons as strokes in a unit
// square, one short function each; the words on keycaps; places: sizes at content scale 1, hidden parts left
// out, the rest for the viewport.
#include "gui/widgets.h"

#include <cstdlib>
#include <iterator>
#include <map>

namespace astrosplat {
namespace {

constexpr float regular_px = 15.0f;
constexpr float small_px = 13.0f;

float scale = 1.0f;  // of the window's monitor; there is one window
int contrast = 0;

// Folders that hold fonts/, most specific first, as the XDG base directory specification has them.
std::vector<fs::path> data_folders() {
    std::vector<fs::path> folders;
    if (const char* home = std::getenv("HOME")) folders.push_back(fs::path(home) / ".local/share");
    const char* listed = std::getenv("XDG_DATA_DIRS");
    const std::string text = listed && *listed ? listed : "/usr/local/share:/usr/share";
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(':', begin), text.size());
        if (end > begin) folders.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    folders.push_back("/usr/share");
    return folders;
}

// Roboto of this weight, where distributions and people put it, else DejaVu.
std::optional<fs::path> find_font(const std::string& weight, const std::string& dejavu) {
    const std::string roboto = "Roboto-" + weight + ".ttf";
    for (const std::string& name :
         {"truetype/roboto/unhinted/RobotoTTF/" + roboto, "truetype/roboto/" + roboto, "Roboto/" + roboto,
          roboto, "truetype/dejavu/" + dejavu})
        for (const fs::path& folder : data_folders()) {
            std::error_code ignored;
            const fs::path file = folder / "fonts" / name;
            if (fs::is_regular_file(file, ignored)) return file;
        }
    return std::nullopt;
}

// Latin-1, Latin Extended-A for names of files, dashes and quotes, a few signs.
const ImWchar* glyph_ranges() {
    static constexpr std::array<ImWchar, 15> ranges{0x0020, 0x00FF, 0x0100, 0x017F, 0x2010,
                                                    0x2026, 0x2032, 0x2033, 0x2190, 0x2193,
                                                    0x2212, 0x2212, 0x2264, 0x2265, 0};
    return ranges.data();
}

ImFont* add_font(const std::optional<fs::path>& file, float size_px) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    ImFontConfig config;
    config.OversampleH = 3;
    config.RasterizerMultiply = 1.1f;
    config.SizePixels = size_px;
    if (file)
        if (ImFont* font = atlas.AddFontFromFileTTF(file->c_str(), size_px, &config, glyph_ranges()))
            return font;
    return atlas.AddFontDefault(&config);
}

void add_fonts(float content_scale) {
    const auto regular = find_font("Regular", "DejaVuSans.ttf");
    ImGui::GetIO().Fonts->Clear();
    const float size = std::round(regular_px * content_scale);
    add_font(regular, size);
    add_font(find_font("Medium", "DejaVuSans-Bold.ttf"), size);
    add_font(regular, std::round(small_px * content_scale));
}

void set_colors(ImGuiStyle& style) {
    const auto set = [&](ImGuiCol which, ImU32 c) { style.Colors[which] = color4(c); };
    for (ImVec4& c : style.Colors) c = color4(color::field);
    set(ImGuiCol_Text, color::text);
    set(ImGuiCol_TextDisabled, color::dim);
    for (const ImGuiCol c : {ImGuiCol_WindowBg, ImGuiCol_ChildBg, ImGuiCol_MenuBarBg}) set(c, color::panel);
    set(ImGuiCol_PopupBg, color::panel);
    for (const ImGuiCol c :
         {ImGuiCol_Border, ImGuiCol_Separator, ImGuiCol_TableBorderLight, ImGuiCol_TableBorderStrong})
        set(c, color::line);
    for (const ImGuiCol c : {ImGuiCol_BorderShadow, ImGuiCol_TableRowBg, ImGuiCol_ScrollbarBg, ImGuiCol_Tab,
                             ImGuiCol_NavWindowingHighlight, ImGuiCol_NavHighlight, ImGuiCol_ResizeGrip})
        set(c, color::none);
    for (const ImGuiCol c : {ImGuiCol_FrameBgHovered, ImGuiCol_ButtonHovered, ImGuiCol_HeaderHovered,
                             ImGuiCol_ScrollbarGrab, ImGuiCol_TabHovered})
        set(c, color::hover);
    for (const ImGuiCol c : {ImGuiCol_FrameBgActive, ImGuiCol_ButtonActive, ImGuiCol_Header,
                             ImGuiCol_HeaderActive, ImGuiCol_TextSelectedBg, ImGuiCol_TabActive})
        set(c, color::selection);
    for (const ImGuiCol c : {ImGuiCol_CheckMark, ImGuiCol_SliderGrab, ImGuiCol_SliderGrabActive,
                             ImGuiCol_DragDropTarget, ImGuiCol_PlotHistogram})
        set(c, color::accent);
    for (const ImGuiCol c : {ImGuiCol_ScrollbarGrabHovered, ImGuiCol_ScrollbarGrabActive}) set(c, color::dim);
    for (const ImGuiCol c : {ImGuiCol_TitleBg, ImGuiCol_TitleBgActive, ImGuiCol_TitleBgCollapsed})
        set(c, color::panel);
    set(ImGuiCol_ModalWindowDimBg, color::with_opacity(color::window, 0.55f));
    style.Colors[ImGuiCol_TableRowBgAlt] = ImVec4(1, 1, 1, 0.02f);
}

void set_sizes(ImGuiStyle& style) {
    style.WindowPadding = {12, 12};
    style.FramePadding = {8, 4};
    style.ItemSpacing = {8, 4};
    style.ItemInnerSpacing = {4, 4};
    style.CellPadding = {4, 2};
    style.IndentSpacing = 12;
    style.ScrollbarSize = 10;
    style.GrabMinSize = 8;
    style.WindowRounding = style.PopupRounding = style.FrameRounding = style.GrabRounding = 3;
    style.ChildRounding = 0;
    style.TabRounding = 0;
    style.ScrollbarRounding = 5;
    style.WindowBorderSize = style.PopupBorderSize = 1;
    style.ChildBorderSize = style.FrameBorderSize = 0;
    style.WindowTitleAlign = {0.0f, 0.5f};
    style.WindowMenuButtonPosition = ImGuiDir_None;
    style.DisabledAlpha = 0.45f;
}

}  // namespace

void set_contrast(int wanted) {
    struct Shade {
        ImU32* color;
        ImU32 normal, high;
    };
    static const Shade shades[] = {{&color::window, color::window, IM_COL32(0x08, 0x09, 0x0A, 255)},
                                   {&color::panel, color::panel, IM_COL32(0x12, 0x14, 0x16, 255)},
                                   {&color::field, color::field, IM_COL32(0x26, 0x2A, 0x2F, 255)},
                                   {&color::hover, color::hover, IM_COL32(0x38, 0x3E, 0x45, 255)},
                                   {&color::line, color::line, IM_COL32(0x5C, 0x63, 0x6A, 255)},
                                   {&color::text, color::text, IM_COL32(0xFF, 0xFF, 0xFF, 255)},
                                   {&color::dim, color::dim, IM_COL32(0xC4, 0xC9, 0xCE, 255)},
                                   {&color::accent, color::accent, IM_COL32(0x7D, 0xB3, 0xF2, 255)},
                                   {&color::attention, color::attention, IM_COL32(0xFF, 0xC1, 0x4D, 255)},
                                   {&color::good, color::good, IM_COL32(0x7F, 0xD6, 0x9A, 255)},
                                   {&color::error, color::error, IM_COL32(0xFF, 0x8F, 0x7E, 255)}};
    contrast = wanted;
    for (const Shade& shade : shades) *shade.color = wanted == 1 ? shade.high : shade.normal;
    color::selection = color::with_opacity(color::accent, 0.28f);
    color::fill = color::with_opacity(color::accent, 0.25f);
    set_colors(ImGui::GetStyle());
}

int theme_contrast() { return contrast; }

void apply_theme(float content_scale, int wanted_contrast) {
    scale = content_scale;
    ImGuiStyle& style = ImGui::GetStyle();
    style = ImGuiStyle();
    set_contrast(wanted_contrast);
    set_sizes(style);
    style.ScaleAllSizes(content_scale);
    add_fonts(content_scale);
    ImGui::GetIO().IniFilename = nullptr;
    hide_ring();
}

ImFont* medium_font() { return ImGui::GetIO().Fonts->Fonts[1]; }
ImFont* small_font() { return ImGui::GetIO().Fonts->Fonts[2]; }

float px(float length) { return length * scale; }

namespace {

constexpr float segment_padding = 10.0f;
constexpr float wait_s = 0.5f;  // before a tooltip

// Length of the UTF-8 character that begins at `at`; bytes that begin none count as one.
std::size_t character_length(const std::string& text, std::size_t at) {
    std::size_t end = at + 1;
    while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
    return end - at;
}

}  // namespace

bool begin_part(const char* name, const Rect& area, ImGuiWindowFlags flags) {
    if (area.width <= 0 || area.height <= 0) return false;
    ImGui::SetCursorScreenPos(area.corner());
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    const bool is_flat = (flags & ImGuiWindowFlags_NoNav) == 0;
    ImGui::BeginChild(name, area.size(), false, is_flat ? flags | ImGuiWindowFlags_NavFlattened : flags);
    ImGui::PopStyleVar();
    is_flat ? enter_part(name) : pass_ring_by();
    return true;
}

void tooltip(const char* text) {
    if (!text || !ImGui::IsItemHovered()) return;
    static ImVec2 resting;  // where the mouse came to rest, and when: one mouse, one tooltip
    static double since = 0.0;
    const ImVec2 mouse = ImGui::GetMousePos();
    if (mouse.x != resting.x || mouse.y != resting.y) {
        resting = mouse;
        since = ImGui::GetTime();
    }
    if (ImGui::GetTime() - since < wait_s) return;
    place_tooltip(ImGui::GetItemRectMin().y);
    ImGui::SetTooltip("%s", text);
}

void place_tooltip(float y) {
    const float left = ImGui::GetWindowPos().x, screen = ImGui::GetIO().DisplaySize.x;
    if (left > 0.4f * screen && !any_popup())  // at most 520 px of at least 900 are the panel's
        ImGui::SetNextWindowPos({left - px(8), y}, ImGuiCond_Always, {1.0f, 0.0f});
}

float segmented_width(std::initializer_list<Segment> segments) {
    float width = 0.0f;
    for (const Segment& segment : segments)
        width += std::round(ImGui::CalcTextSize(segment.label).x + 2 * px(segment_padding));
    return width;
}

void push_field_height(float height) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        ImVec2(px(8), std::floor((height - ImGui::GetFontSize()) * 0.5f)));
}

bool any_popup() {
    return ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
}

void close_on_escape() {
    if (key_pressed(key_code::escape)) ImGui::CloseCurrentPopup();
}

namespace {

float whole(float length) { return std::max(1.0f, std::round(length)); }

/// The first of `width` pixels around the one that `at` lies in.
float first_pixel(float at, float width) { return std::floor(at - 0.5f * (width - 1.0f)); }

/// The border between two pixels that is nearest; of two the right or lower one.
ImVec2 border(ImVec2 p) { return {std::floor(p.x + 0.5f), std::floor(p.y + 0.5f)}; }

void strip_across(ImDrawList* list, float x0, float x1, float y, ImU32 ink, float width) {
    const float w = whole(width), top = first_pixel(y, w);
    list->AddRectFilled({border({x0, 0}).x, top}, {border({x1, 0}).x, top + w}, ink);
}

void strip_down(ImDrawList* list, float x, float y0, float y1, ImU32 ink, float width) {
    const float w = whole(width), left = first_pixel(x, w);
    list->AddRectFilled({left, border({0, y0}).y}, {left + w, border({0, y1}).y}, ink);
}

}  // namespace

void fill_rect(ImVec2 low, ImVec2 high, ImU32 ink, float radius) {
    ImGui::GetWindowDrawList()->AddRectFilled(border(low), border(high), ink, radius);
}
void fill_rect(const Rect& area, ImU32 ink, float radius) {
    fill_rect(area.corner(), area.end(), ink, radius);
}
void fill_square(ImVec2 middle, float half, ImU32 ink) {
    const float side = 2.0f * std::round(half) + 1.0f;
    const ImVec2 corner{first_pixel(middle.x, side), first_pixel(middle.y, side)};
    fill_rect(corner, {corner.x + side, corner.y + side}, ink);
}
void outline_rect(const Rect& area, ImU32 ink, float radius, float width) {
    ImDrawList* const list = ImGui::GetWindowDrawList();
    const float w = whole(width), half = 0.5f * w;
    const ImVec2 low = border(area.corner()), high = border(area.end());
    list->PathRect({low.x + half, low.y + half}, {high.x - half, high.y - half}, radius);
    list->PathStroke(ink, ImDrawFlags_Closed, w);
}
void line_across(float x0, float x1, float y, ImU32 ink, float width) {
    strip_across(ImGui::GetWindowDrawList(), x0, x1, y, ink, width);
}
void line_down(float x, float y0, float y1, ImU32 ink, float width) {
    strip_down(ImGui::GetWindowDrawList(), x, y0, y1, ink, width);
}
void draw_line(ImVec2 from, ImVec2 to, ImU32 ink, float width) {
    ImGui::GetWindowDrawList()->AddLine(from, to, ink, width);
}
void draw_text(ImVec2 at, ImU32 ink, const std::string& text) {
    ImGui::GetWindowDrawList()->AddText(at, ink, text.c_str());
}

void row_text(const std::string& text, float row_height, ImU32 text_color) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    ImGui::GetWindowDrawList()->AddText({at.x, at.y + std::floor((row_height - size.y) * 0.5f)}, text_color,
                                        text.c_str());
    ImGui::Dummy({size.x, row_height});
}

void progress_bar(ImVec2 corner, float width, float share) {
    const float done = corner.x + width * std::clamp(share, 0.0f, 1.0f), bottom = corner.y + px(4);
    fill_rect(corner, {corner.x + width, bottom}, color::field, px(2));
    fill_rect(corner, {done, bottom}, color::accent, px(2));
}

void image_box(const Rect& area, ImTextureID texture, float aspect, float radius) {
    ImDrawList* const list = ImGui::GetWindowDrawList();
    fill_rect(area, IM_COL32_BLACK, px(radius));
    if (!texture || aspect <= 0) return;
    const float w = std::max(px(1), std::min(area.width, area.height * aspect));
    const float h = std::max(px(1), std::min(area.height, area.width / aspect));
    const float x = area.x + (area.width - w) * 0.5f, y = area.y + (area.height - h) * 0.5f;
    list->AddImage(texture, {x, y}, {x + w, y + h});
}

bool begin_menu_popup(const char* id) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(8), px(8)));
    const bool open = ImGui::BeginPopup(id);
    ImGui::PopStyleVar();
    if (open) ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(12), px(8)));
    return open;
}

void end_menu_popup() {
    close_on_escape();
    ImGui::PopStyleVar();
    ImGui::EndPopup();
}

std::string fitting(const std::string& text, float width) {
    if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
    std::vector<std::string> characters;
    for (std::size_t i = 0; i < text.size(); i += characters.back().size())
        characters.push_back(text.substr(i, character_length(text, i)));
    // Takes characters out of the middle, one after the other.
    std::size_t head = characters.size() / 2, tail = characters.size() - head;
    while (head + tail > 2) {
        (head > tail ? head : tail)--;
        std::string shorter;
        for (std::size_t i = 0; i < head; ++i) shorter += characters[i];
        shorter += "\xE2\x80\xA6";
        for (std::size_t i = characters.size() - tail; i < characters.size(); ++i) shorter += characters[i];
        if (ImGui::CalcTextSize(shorter.c_str()).x <= width) return shorter;
    }
    return "\xE2\x80\xA6";
}

namespace {

// Icon coordinates run from -1 to 1, x right, y down.
struct Pen {
    ImDrawList* list;
    ImVec2 center;  // the middle of a pixel
    float half;
    ImU32 color;
    float width;

    ImVec2 at(float x, float y) const { return {center.x + x * half, center.y + y * half}; }
    /// The middle of the pixel there: corners of strokes whose sides lie along an axis.
    ImVec2 pixel(float x, float y) const {
        const ImVec2 p = at(x, y);
        return {std::floor(p.x) + 0.5f, std::floor(p.y) + 0.5f};
    }
    void line(float x0, float y0, float x1, float y1) const {
        list->PathLineTo(at(x0, y0));
        list->PathLineTo(at(x1, y1));
        list->PathStroke(color, ImDrawFlags_None, width);
    }
    void across(float x0, float x1, float y) const {
        strip_across(list, pixel(x0, y).x - 0.5f, pixel(x1, y).x + 0.5f, pixel(x0, y).y, color, width);
    }
    void down(float x, float y0, float y1) const {
        strip_down(list, pixel(x, y0).x, pixel(x, y0).y - 0.5f, pixel(x, y1).y + 0.5f, color, width);
    }
    void path(std::initializer_list<ImVec2> points, bool closed) const {
        for (const ImVec2& p : points) list->PathLineTo(at(p.x, p.y));
        list->PathStroke(color, closed ? ImDrawFlags_Closed : ImDrawFlags_None, width);
    }
    /// A closed path with sides along an axis.
    void shape(std::initializer_list<ImVec2> points) const {
        for (const ImVec2& p : points) list->PathLineTo(pixel(p.x, p.y));
        list->PathStroke(color, ImDrawFlags_Closed, whole(width));
    }
    void circle(float radius) const { list->AddCircle(center, radius * half, color, 0, width); }
    void arc(ImVec2 from, ImVec2 control, ImVec2 to) const {
        list->PathLineTo(at(from.x, from.y));
        list->PathBezierQuadraticCurveTo(at(control.x, control.y), at(to.x, to.y));
        list->PathStroke(color, ImDrawFlags_None, width);
    }
};

void eye(const Pen& pen) {
    pen.list->PathLineTo(pen.at(-1.0f, 0.0f));
    pen.list->PathBezierQuadraticCurveTo(pen.at(0.0f, -1.15f), pen.at(1.0f, 0.0f));
    pen.list->PathBezierQuadraticCurveTo(pen.at(0.0f, 1.15f), pen.at(-0.99f, 0.0f));
    pen.list->PathStroke(pen.color, ImDrawFlags_Closed, pen.width);
    pen.list->AddCircleFilled(pen.center, 0.3f * pen.half, pen.color);
}
void eye_closed(const Pen& pen) { pen.arc({-1, -0.1f}, {0, 0.95f}, {1, -0.1f}); }
void diamond(const Pen& pen) {
    pen.list->AddQuadFilled(pen.at(0, -0.85f), pen.at(0.85f, 0), pen.at(0, 0.85f), pen.at(-0.85f, 0),
                            pen.color);
}
void diamond_empty(const Pen& pen) { pen.path({{0, -0.75f}, {0.75f, 0}, {0, 0.75f}, {-0.75f, 0}}, true); }
void play(const Pen& pen) {
    const ImVec2 top = border(pen.at(-0.6f, -0.85f));
    pen.list->AddTriangleFilled(top, pen.at(0.85f, 0.0f), {top.x, pen.at(0.0f, 0.85f).y}, pen.color);
}
void pause(const Pen& pen) {
    for (const float left : {-0.7f, 0.2f})
        pen.list->AddRectFilled(border(pen.at(left, -0.8f)), border(pen.at(left + 0.5f, 0.8f)), pen.color);
}
void chevron_right(const Pen& pen) { pen.path({{-0.3f, -0.65f}, {0.4f, 0}, {-0.3f, 0.65f}}, false); }
void chevron_down(const Pen& pen) { pen.path({{-0.65f, -0.3f}, {0, 0.4f}, {0.65f, -0.3f}}, false); }
void chevron_up(const Pen& pen) { pen.path({{-0.65f, 0.3f}, {0, -0.4f}, {0.65f, 0.3f}}, false); }
void plus(const Pen& pen) {
    pen.across(-0.8f, 0.8f, 0);
    pen.down(0, -0.8f, 0.8f);
}
void cross(const Pen& pen) {
    pen.line(-0.58f, -0.58f, 0.58f, 0.58f);
    pen.line(-0.58f, 0.58f, 0.58f, -0.58f);
}
void ring(const Pen& pen) { pen.circle(0.7f); }
void ring_cut(const Pen& pen) {
    ring(pen);
    pen.list->PathArcTo(pen.center, 0.7f * pen.half, -0.785f, 2.356f);
    pen.list->PathFillConvex(pen.color);
}
void curve(const Pen& pen) {
    pen.list->PathLineTo(pen.at(-0.85f, 0.7f));
    pen.list->PathBezierCubicCurveTo(pen.at(0.1f, 0.7f), pen.at(-0.1f, -0.7f), pen.at(0.85f, -0.7f));
    pen.list->PathStroke(pen.color, ImDrawFlags_None, pen.width);
}
void warning(const Pen& pen) {
    pen.shape({{0, -0.8f}, {0.9f, 0.75f}, {-0.9f, 0.75f}});
    pen.down(0, -0.25f, 0.2f);
    pen.down(0, 0.5f, 0.5f);
}
void folder(const Pen& pen) {
    pen.shape(
        {{-0.85f, -0.6f}, {-0.25f, -0.6f}, {0, -0.35f}, {0.85f, -0.35f}, {0.85f, 0.65f}, {-0.85f, 0.65f}});
}
void file(const Pen& pen) {
    pen.shape({{-0.6f, -0.85f}, {0.2f, -0.85f}, {0.6f, -0.4f}, {0.6f, 0.85f}, {-0.6f, 0.85f}});
}
void dots(const Pen& pen) {
    for (const float x : {-0.7f, 0.0f, 0.7f})
        pen.list->AddCircleFilled(pen.at(x, 0), 0.18f * pen.half, pen.color);
}

void tick(const Pen& pen) { pen.path({{-0.75f, 0.05f}, {-0.2f, 0.6f}, {0.75f, -0.55f}}, false); }

/// An eyedropper.
void pick(const Pen& pen) {
    pen.path(
        {{-0.8f, 0.8f}, {-0.65f, 0.25f}, {0.05f, -0.45f}, {0.45f, -0.05f}, {-0.25f, 0.65f}, {-0.8f, 0.8f}},
        false);
    pen.path({{-0.2f, -0.6f}, {0.6f, 0.2f}}, false);
    pen.path({{0.3f, -0.3f}, {0.75f, -0.75f}}, false);
}

using Draw = void (*)(const Pen&);
constexpr Draw drawings[] = {eye,          eye_closed, diamond, diamond_empty, play, pause,    chevron_right,
                             chevron_down, chevron_up, plus,    cross,         ring, ring_cut, curve,
                             warning,      folder,     file,    dots,          tick, pick};
static_assert(std::size(drawings) == static_cast<std::size_t>(Icon::pick) + 1);

}  // namespace

void draw_icon(ImDrawList* list, Icon icon, ImVec2 center, float size, ImU32 color) {
    // Odd line centres fall on pixel centres and stay sharp.
    const ImVec2 snapped{std::floor(center.x) + 0.5f, std::floor(center.y) + 0.5f};
    drawings[static_cast<std::size_t>(icon)]({list, snapped, size * 0.5f, color, px(1.3f)});
}

void draw_bracket(ImDrawList* list, float x, float y0, float y1, ImU32 color) {
    const float width = whole(px(1.0f)), tip = x + px(4.0f);
    strip_down(list, x, first_pixel(y0, width) + width, first_pixel(y1, width), color, width);
    for (const float y : {y0, y1}) strip_across(list, x, tip, y, color, width);
}

bool icon_button(const char* id, Icon icon, ImVec2 size, float icon_px, ImU32 color, const char* says) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const bool clicked = ImGui::InvisibleButton(id, size);
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (ImGui::IsItemHovered())
        fill_rect(corner, {corner.x + size.x, corner.y + size.y}, color::hover, px(3.0f));
    tooltip(says);
    draw_icon(list, icon, {corner.x + size.x * 0.5f, corner.y + size.y * 0.5f}, icon_px, color);
    return clicked;
}

namespace {

std::string key_name(int code) {
    using namespace key_code;
    static const std::map<int, std::string> words = {
        {0, ""},        {space, "Space"}, {escape, "Esc"}, {tab, "Tab"},   {del, "Del"}, {right, "Right"},
        {left, "Left"}, {down, "Down"},   {up, "Up"},      {home, "Home"}, {end, "End"}, {f1, "F1"},
        {f6, "F6"},     {f10, "F10"},     {f11, "F11"},    {f12, "F12"}};
    if (const auto word = words.find(code); word != words.end()) return word->second;
    return code > 0 && code < 128 ? std::string(1, static_cast<char>(code)) : "";  // letters and digits
}

}  // namespace

bool key_pressed(int code, bool repeats) { return ImGui::IsKeyPressed(static_cast<ImGuiKey>(code), repeats); }

bool key_down(int code) { return ImGui::IsKeyDown(static_cast<ImGuiKey>(code)); }

bool shortcut_pressed(const Shortcut& s, bool repeats) {
    const ImGuiIO& io = ImGui::GetIO();
    if (s.code == 0 || io.KeyAlt || io.KeyCtrl != s.ctrl || io.KeyShift != s.shift) return false;
    return key_pressed(s.code, repeats);
}

std::string shortcut_text(const Shortcut& s) {
    return std::string(s.ctrl ? "Ctrl+" : "") + (s.shift ? "Shift+" : "") + key_name(s.code);
}

namespace {

constexpr float menu_height = 28, tool_height = 32, status_height = 24, notice_height = 30;
constexpr float snapshots_height = 124, timeline_closed = 36, timeline_with_graph = 240;
constexpr float smallest_viewport = 160;

// Cuts a strip off `rest` and returns it.
Rect cut_top(Rect& rest, float height) {
    height = std::min(height, rest.height);
    const Rect strip{rest.x, rest.y, rest.width, height};
    rest.y += height;
    rest.height -= height;
    return strip;
}
Rect cut_bottom(Rect& rest, float height) {
    height = std::min(height, rest.height);
    rest.height -= height;
    return {rest.x, rest.end().y, rest.width, height};
}
Rect cut_right(Rect& rest, float width) {
    width = std::min(width, rest.width);
    rest.width -= width;
    return {rest.end().x, rest.y, width, rest.height};
}

float timeline_size(const ViewState& view) {
    if (!view.panels) return 0.0f;
    if (!view.timeline_open) return timeline_closed;
    return view.graph_open ? std::max(view.timeline_height, timeline_with_graph) : view.timeline_height;
}

}  // namespace

Layout make_layout(const ViewState& view, float width_px, float height_px, float content_scale) {
    const auto scaled = [&](float length) { return std::round(length * content_scale); };
    Layout layout;
    Rect rest{0, 0, width_px, height_px};
    layout.menu = cut_top(rest, scaled(menu_height));
    layout.status = cut_bottom(rest, scaled(status_height));
    layout.panel = cut_right(rest, view.panels ? scaled(view.panel_width) : 0.0f);
    layout.tools = cut_top(rest, view.panels ? scaled(tool_height) : 0.0f);
    const bool notice = view.hint_open || view.changed_on_disk || !view.grey_layer.empty();
    layout.notice = cut_top(rest, notice ? scaled(notice_height) : 0.0f);
    const float most = std::max(rest.height - scaled(smallest_viewport), scaled(timeline_closed));
    layout.timeline = cut_bottom(rest, std::min(scaled(timeline_size(view)), view.panels ? most : 0.0f));
    layout.snapshots = cut_bottom(rest, view.panels && view.snapshots_open ? scaled(snapshots_height) : 0.0f);
    layout.viewport = rest;
    return layout;
}

Rect place_frame(const ViewState& view, const Rect& viewport, int width_px, int height_px) {
    const double w = std::max(width_px, 1), h = std::max(height_px, 1);
    double scale = view.zoom, shift_x = view.pan_px.x, shift_y = view.pan_px.y;
    if (view.size == SizeMode::fit) {
        scale = std::min(viewport.width / w, viewport.height / h);
        shift_x = shift_y = 0.0;
    }
    // Whole pixels, so that a frame of the viewport's own size is shown pixel by pixel.
    const double x = viewport.x + std::floor((viewport.width - w * scale) * 0.5 + shift_x + 0.5);
    const double y = viewport.y + std::floor((viewport.height - h * scale) * 0.5 + shift_y + 0.5);
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(w * scale),
            static_cast<float>(h * scale)};
}

}  // namespace astrosplat
