// The parts of the side panel, each drawn at the cursor of the current ImGui window: the list of layers,
// tabs, and the row of one parameter with its widget, its plot and its words, all from the parameter's
// description. Beneath these, what knows nothing of parameters: a field for one value, folding sections,
// heads, notes, buttons; and values in words, which do not depend on the locale.
#pragma once

#include <initializer_list>

#include "gui/panel/context.h"
#include "gui/widgets.h"
#include "scene/parameter.h"

namespace astrosplat::panel {

/// Draws the row of a parameter.
void parameter_row(Context& context, const Parameter& parameter);

/// The places of a row's parts.
struct RowLayout {
    Rect whole, label, value;
    ImVec2 diamond;  // its middle
};

struct Row {
    const Parameter& parameter;
    Value value;  // at the current frame
    RowLayout layout;
    const ParameterKey& key() const { return parameter.spec.key; }
};

/// The value's widget by the parameter's type. True where it took more than one row's height, and the cursor
/// stands below it already.
bool value_field(Context& context, const Row& row);

/// A drawing above the row of this parameter; none for most.
void draw_above(Context& context, const ParameterSpec& spec);

/// The word shown in place of a value that is not set, as 0 where that is no amount, with the value in use
/// where it is known: "Off", "Auto (0.0165)". Empty: it is set.
std::string unset_in_words(const Context& context, const ParameterSpec& spec, const Value& value);

/// The number that a value that is not set is dragged or typed from: the one in use as the words show it,
/// else the middle of the slider's range.
double first_value(const Context& context, const ParameterSpec& spec);

/// The names that a row of colour management offers besides the empty one; none: it is no such row, or they
/// are not known.
std::optional<std::vector<std::string>> names_to_choose(const Context& context, const ParameterSpec& spec);

/// The text of a row whose value is empty: "Screen (first)"; "None" for most.
std::string empty_in_words(const Context& context, const ParameterSpec& spec);

/// Whether there is anything to choose in a row of colour management; true for all others.
bool suits_colors(const Context& context, const ParameterSpec& spec);

/// At the head of the folded section of colour management: "Screen, Film".
std::string colors_state(const Context& context);

/// The tab `name`, as ParameterSpec::tab has it. Layers' tabs show the selected layer; there must be one.
void draw_tab(Context& context, std::string_view name);

/// It has an effect now: a row of its tab.
bool is_shown(const Context& context, const ParameterSpec& spec);

/// The content of a section of a tab besides its parameters: the words at its head, which rows come first,
/// what follows the last. A section that is not listed has its rows alone.
struct TabSection {
    std::string_view tab;
    std::string title;
    bool (*is_open)(const Context&) = nullptr;       // at first; nullptr: folded
    std::string (*state)(const Context&) = nullptr;  // at the head while it is folded
    std::vector<ParameterKey> first = {};            // generic keys or groups; the others follow as described
    void (*last)(Context&) = nullptr;                // below the rows
    bool (*is_there)(const Context&) = nullptr;      // nullptr: always
};

/// In the order of the tabs.
std::span<const TabSection> tab_sections();

/// The place of a section in its tab for the selected layer: of bodies, what a picture needs comes first and
/// what its files are made of last. Smaller ones come first, equal ones as in tab_sections().
int order_of(const Context& context, const TabSection& section);

/// The words at its head: the files of bodies are "More".
const char* head_of(const Context& context, const TabSection& section);

/// The place of a row in its section: smaller ones come first, equal ones as described.
std::size_t rank_in(const TabSection& section, const ParameterSpec& spec);

/// Whether a parameter makes sense for the selected layer and the view, where that takes more than other
/// parameters' values to say (ParameterSpec::conditions): those of FITS files, a lattice where there are
/// bodies, a density that stops replace, and references of other views.
bool suits_layer(const Context& context, const ParameterSpec& spec);

// At the end of sections (section_ends.cpp).

/// The two images with a line between them to drag, what was done, a button.
void draw_preparation(Context& context);
void detail_buttons(Context& context);
void placement_buttons(Context& context);
void crop_buttons(Context& context);
void reference_buttons(Context& context);
/// Below the rows of colour management: why the configuration cannot be used.
void colors_note(Context& context);
/// Commands on a layer's look as a whole, as buttons or as items of a menu.
void look_buttons(Context& context);
void look_menu(Context& context);

// At the top of tabs.
void source_state(Context& context);
void camera_buttons(Context& context);
void output_buttons(Context& context);

/// Draws the list of layers over the width of the current window, `height` px at most; longer lists scroll.
void layer_list(Context& context, float height);

/// Of a switch of a layer: its sign, and what that stands on where it is not the row itself. At least 3 to 1
/// on every row, also on the selected one.
struct SwitchColors {
    ImU32 ink, ground;
};
SwitchColors switch_colors(bool on, bool hovered);

/// The plus that adds a layer, with its menu.
void add_layer_button(Context& context);

/// How far layer i is generated, or that it has to be, with the button that stops or begins it.
void load_line(Context& context, std::size_t i, float width, const std::string& loading,
               const std::string& stale);

/// Height the whole list would take, px.
float layer_list_height(const Context& context);

inline constexpr float plot_height = 84.0f;  // px at scale 1

/// The next plot's area across the panel; draws its ground.
Rect begin_plot(float height = plot_height);

/// Bars over [0, 1] of the width; `stretch` widens the bins' own range: bin i covers
/// [i, i + 1] * stretch / count. Shares of the fullest bin.
void draw_bars(const Rect& area, std::span<const float> shares, double stretch = 1.0);

/// A line through values spread evenly over `stretch` of the width; 0 is the bottom, `top` the upper edge.
void draw_curve(const Rect& area, std::span<const float> values, float top, ImU32 color,
                float stretch = 1.0f);

/// A plot of the curve whose points the parameter `key` holds: click adds, drag moves, right click deletes,
/// arrows nudge. `samples` is the curve itself, over x in 0..1. The area takes the mouse.
void edit_curve(Context& context, const ParameterKey& key, const Rect& area, std::span<const float> samples);

/// Small texts below a plot, at its left and right edge. Leaves the cursor below.
void captions(const std::string& left, const std::string& right);

inline constexpr float row_height = 24.0f, row_space = 2.0f;  // px at scale 1

// A field: dragging changes a number, a double click types it. Draws the faint fill and the unit.

struct BoxContent {
    std::string shown, unit;
    std::string typed;   // what typing begins with
    double value = 0.0;  // what dragging begins with
    double step = 0.0;   // per px of dragging; 0: cannot be dragged
    double min = 0.0, max = 0.0;
    bool whole = false;   // whole numbers
    float fill = -1.0f;   // 0..1 of the width; below 0: none
    bool dimmed = false;  // not set: "Auto"
};

struct BoxEvent {
    enum class Kind { none, dragged, typed } kind = Kind::none;
    double value = 0.0;
    std::string text;
};

BoxEvent value_box(Context& context, const char* id, const Rect& area, const BoxContent& content);

/// Whether a box of this size shows all of the text, without a unit.
bool fits_box(const Rect& area, const std::string& text);

/// Where the mouse is from left to right, 0..1.
float share_at_mouse(const Rect& area);

/// Text at the left, ended by "..." where it is too long; returns its width.
float clipped_text(const Rect& area, float padding, ImU32 color, const std::string& text);

/// Head of a folding section, with its state at the right while it is closed. True when open.
bool section(Context& context, const char* title, const std::string& state, bool open_at_first = false);

/// Head of one element of a list; true when its cross was clicked.
bool element_head(const char* title);

/// ImGui's popup with the room of a menu between its items; end_menu_popup (widgets.h) only after true.
bool begin_popup(const char* id);

/// A line or more of small, quiet text.
void note(const std::string& text, ImU32 ink = color::dim);

/// A button as wide as `width` (0: as its text). True when clicked.
bool text_button(const char* label, float width = 0.0f);

/// Buttons that share one line evenly, remembered as "panel/LABEL": index of the one clicked, -1 none.
int button_line(Context& context, std::initializer_list<const char*> labels);

/// A quiet "+ label" that adds an element to a list; true when clicked.
bool add_line(const char* label);

/// A bar with text over it, and a button at its right; true when the button was clicked. A share of 0 is no
/// progress but something that waits for the button.
bool progress_line(float width, float share, const std::string& text, const char* button);

/// Three figures at least, five where the number has them: "0.350", "45.0", "12.345", "2 000 000".
std::string figures(double number);

/// Of an integer: groups of three from 10,000 on.
std::string figures(std::int64_t number);

/// As above, with fewer figures (4, 3, 2, 1) until `fits` says yes; the shortest of them where none fits. In
/// a narrow box 1.2346 is "1.23"; digits before the point are never dropped.
std::string figures_that_fit(double number, const std::function<bool(const std::string&)>& fits);

/// "61 %"; `share` 0..1.
std::string percent(double share);

/// A choice as people write it: "gaussian" -> "Gaussian", "srgb" -> "sRGB".
std::string choice_label(const std::string& choice);

/// A value on one line, for tooltips and boxes that take any text: files by their names, nothing as "Auto".
std::string in_words(const ParameterSpec& spec, const Value& value);

/// Help and range in words, then the key: what a row's tooltip says.
std::string tooltip_text(const ParameterSpec& spec, const Value& standard);

/// `--set key=value` as one word of a shell.
std::string set_option(const std::string& key, const Value& value);

/// How much a parameter changes per pixel of dragging at `value`: a share of its range where that is short,
/// of itself where it spans magnitudes.
double drag_step(const ParameterSpec& spec, double value);

}  // namespace astrosplat::panel
