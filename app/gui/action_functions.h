// The actions of actions.cpp that take more than one line, and when they can be done.
#pragma once

#include <string>

#include "gui/gui_frame.h"

namespace astrosplat {

void undo(GuiFrame& f);
void redo(GuiFrame& f);
bool can_undo(const GuiFrame& f);
bool can_redo(const GuiFrame& f);
std::string undo_label(const GuiFrame& f);  // "Undo Opacity of dust"
std::string redo_label(const GuiFrame& f);
void take_snapshot(GuiFrame& f);
void new_empty_scene(GuiFrame& f);

bool has_file(const GuiFrame& f);
bool has_layer(const GuiFrame& f);
bool has_box(const GuiFrame& f);
bool has_job(const GuiFrame& f);
bool has_ffmpeg(const GuiFrame& f);
std::string movie_label(const GuiFrame& f);

void three_quarter(GuiFrame& f);
void toggle_one_to_one(GuiFrame& f);
bool is_one_to_one(const GuiFrame& f);
void set_compare(GuiFrame& f, CompareMode mode);   // asks for a reference where there is none yet
void compare_with(GuiFrame& f, CompareWith with);  // likewise
void toggle_compare_with_reference(GuiFrame& f);
bool compares_with_reference(const GuiFrame& f);
void toggle_blink(GuiFrame& f);
bool blinks(const GuiFrame& f);
bool has_reference(const GuiFrame& f);
void toggle_placing(GuiFrame& f);
bool is_placing(const GuiFrame& f);
void toggle_front(GuiFrame& f);
bool has_front(const GuiFrame& f);
bool shows_front(const GuiFrame& f);
void swap_a_b(GuiFrame& f);

void duplicate_selected_layer(GuiFrame& f);
void remove_selected_layer(GuiFrame& f);
void hide_layer(GuiFrame& f);
void solo_layer(GuiFrame& f);
bool layer_visible(const GuiFrame& f);
bool layer_solo(const GuiFrame& f);
void move_layer_up(GuiFrame& f);
void move_layer_down(GuiFrame& f);
bool can_move_up(const GuiFrame& f);
bool can_move_down(const GuiFrame& f);
bool layer_stale(const GuiFrame& f);

bool in_free_view(const GuiFrame& f);
/// A square fisheye of half the sphere, so many px wide: what planetariums project.
void make_dome_master(GuiFrame& f, std::int64_t side_px);
void set_camera_keyframe_here(GuiFrame& f);  // what is seen, as the panel's button does
void camera_from_view(GuiFrame& f);

void next_frame(GuiFrame& f);
void previous_frame(GuiFrame& f);
void next_keyframe(GuiFrame& f);
void previous_keyframe(GuiFrame& f);
void first_frame(GuiFrame& f);
void last_frame(GuiFrame& f);
void set_in_point(GuiFrame& f);
void set_out_point(GuiFrame& f);
void clear_in_and_out(GuiFrame& f);
void set_keyframe_here(GuiFrame& f);
void remove_keyframe_here(GuiFrame& f);
void cancel(GuiFrame& f);

/// Handles in the view: on for this tool, or off where it is at work.
void choose_handles(GuiFrame& f, HandleTool tool);
template <HandleTool tool>
void toggle_handles(GuiFrame& f) {
    choose_handles(f, tool);
}
template <HandleTool tool>
bool has_handles(const GuiFrame& f) {
    return f.view.tool == tool && f.view.handle_target != HandleTarget::camera_target;
}
/// Of the scene's camera, which gets a place of its own where it has none.
void move_camera_target(GuiFrame& f);
bool moves_camera_target(const GuiFrame& f);

}  // namespace astrosplat
