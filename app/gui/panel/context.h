// What the parts of the panel share while it is drawn, and what it remembers from frame to frame.
#pragma once

#include <imgui.h>

#include <glm/vec4.hpp>
#include <map>
#include <set>
#include <unordered_map>

#include "gui/gui_frame.h"
#include "scene/describe.h"

namespace astrosplat::panel {

/// The scene as it stands at the current frame, described. Made again when the document or the frame changes.
struct Described {
    const Document* document = nullptr;
    std::uint64_t revision = 0;
    double frame = 0.0;
    std::unique_ptr<Scene> scene;  // the handles below point into it
    Description description;
    std::unordered_map<std::string, const Parameter*> by_key;
};

/// A value being dragged or typed. There is only one at a time.
struct Touch {
    ImGuiID drag = 0, entry = 0;  // the widget; 0: none
    double value = 0.0;           // dragged so far, not rounded
    float mouse_x = 0.0f;         // up to which it was dragged
    std::string text;             // typed so far
    int entry_frames = 0;         // since the text field appeared
    bool seen = false;            // its widget was drawn in this frame
    bool to_next = false;         // Tab: the next field is typed into
};

/// The field of a noise, drawn once: greys at the corners of cells, row by row.
struct NoiseSketch {
    Noise noise;
    double span = 0.0;  // scene units across
    int columns = 0;
    std::vector<ImU32> greys;
};

struct Memory {
    Described described;
    std::vector<DrawnRow> rows;              // of this frame
    std::map<ParameterKey, Value> defaults;  // by generic key
    Touch touch;
    Gesture gesture = 0;               // of the drag that runs; a new one for every press
    ParameterKey error_key;            // parameter whose last edit was refused
    std::string error;                 // why
    std::uint64_t error_revision = 0;  // of the document: what comes later ends it
    bool error_shown = false;          // beside its row, in this frame
    std::map<std::pair<PanelTab, std::string>, bool> open;  // sections, by tab and title
    bool all_open = false;                                  // in the next frame every section unfolds
    bool after_open = false;                                // the section above is unfolded: leave some room
    std::map<ParameterKey, Rect> plots;                     // by the key they edit
    ParameterKey selected_curve;                            // the one whose point is selected
    int selected_point = -1;
    PanelTab layer_tab = PanelTab::look, scene_tab = PanelTab::camera;  // seen last
    std::string renaming;                                               // layer whose name is typed
    int dragged_layer = -1;
    std::size_t layer_in_sight = 0;      // selected in the last frame
    std::set<std::string> second_lines;  // layers whose row has one
    std::vector<NoiseSketch> noises;     // by entry of the list
    float preparation_line = 0.5f;       // between before and after, 0..1 of the width
    float scroll = 0.0f;                 // how far the tab can be scrolled
    ParameterKey hovered;                // row under the mouse, and since when: tooltips wait a little
    double hovered_since = 0.0;
    ParameterKey wanted;                  // its field gets the ring in the next frame
    std::optional<ParameterKey> request;  // whose file is asked for
};

struct Context : GuiFrame {
    Memory& memory;
    const Scene& scene() const { return *memory.described.scene; }
    /// The selected layer at the current frame; there must be one.
    const LayerParams& layer() const { return scene().layers[view.layer]; }
    /// "layer.dust"; empty without layers.
    ParameterKey layer_key() const;
    /// Its status, or that of layer i; an empty one while the viewer has not heard of the layer.
    const LayerStatus& layer_status() const { return layer_status(view.layer); }
    const LayerStatus& layer_status(std::size_t i) const;
};

/// Brings memory.described up to date.
void describe_current(Memory& memory, const Document& document, double frame);

/// nullptr when there is no such parameter (any more).
const Parameter* find(const Context& context, const ParameterKey& key);

/// Its default in a new scene.
const Value& default_of(Context& context, const ParameterSpec& spec);

/// A fresh id for edits of the press that begins now.
Gesture begin_gesture(Context& context);

/// Runs an edit; a refusal becomes the message of the row `key`.
void attempt(Context& context, const ParameterKey& key, const std::function<void()>& change);

// Rules between parameters (engine/scene/check.h) as a person meets them.

/// An edit that has to come first so that another one can stand.
struct Companion {
    ParameterKey key;
    Value value;
};

/// To be set before `key` is set to `value`, in this order; empty where nothing else is concerned. `scene`
/// as it stands at the frame.
std::vector<Companion> companions(const Scene& scene, const ParameterKey& key, const Value& value);

/// The place in its list of the element that a parameter is of: 2 of "look.noise.2.cull".
std::size_t place_in_list(const ParameterKey& key);

/// Document::set at the current frame, with what else must change for it to stand, as one undo step; a
/// refusal becomes the row's message. `gesture` 0: a step of its own.
void set_value(Context& context, const ParameterKey& key, const Value& value, Gesture gesture = 0);

/// Document::edit; a refusal becomes the message of the row `key`.
void edit(Context& context, const ParameterKey& key, const std::string& name,
          const std::function<void(Scene&)>& change, Gesture gesture = 0);

/// TOML, or a bare word: what a person may paste or type. Numbers may have a comma.
Value value_from_text(const std::string& text, const ParameterSpec& spec);

}  // namespace astrosplat::panel
