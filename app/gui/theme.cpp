// Colours, spacing and fonts into ImGui's style and font atlas.
#include "gui/theme.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace astrosplat {
namespace fs = std::filesystem;
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
                             ImGuiCol_NavWindowingHighlight, ImGuiCol_ResizeGrip})
        set(c, color::none);
    for (const ImGuiCol c : {ImGuiCol_FrameBgHovered, ImGuiCol_ButtonHovered, ImGuiCol_HeaderHovered,
                             ImGuiCol_ScrollbarGrab, ImGuiCol_TabHovered})
        set(c, color::hover);
    for (const ImGuiCol c : {ImGuiCol_FrameBgActive, ImGuiCol_ButtonActive, ImGuiCol_Header,
                             ImGuiCol_HeaderActive, ImGuiCol_TextSelectedBg, ImGuiCol_TabActive})
        set(c, color::selection);
    for (const ImGuiCol c : {ImGuiCol_CheckMark, ImGuiCol_SliderGrab, ImGuiCol_SliderGrabActive,
                             ImGuiCol_DragDropTarget, ImGuiCol_NavHighlight, ImGuiCol_PlotHistogram})
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
}

ImFont* medium_font() { return ImGui::GetIO().Fonts->Fonts[1]; }
ImFont* small_font() { return ImGui::GetIO().Fonts->Fonts[2]; }

float px(float length) { return length * scale; }

}  // namespace astrosplat
