// --device: what draws frames, the processor or a graphics card that has its bits.
#pragma once

#include <memory>
#include <string>

#include "command.h"
#include "render/frame.h"

namespace astrosplat {

/// Throws where the text is none.
DeviceChoice parse_device(const std::string& text);

/// Draws the frames of one command, on the thread that made it.
class FrameDevice {
  public:
    /// Automatic takes a graphics card that is there and exact, and says why not in the log's details. Throws
    /// InputError where a card is asked for and there is none.
    explicit FrameDevice(const CommandOptions& options);
    ~FrameDevice();

    RenderDevice* get() const;  // null: the processor draws
    /// "the processor" or the card's name.
    std::string name() const;
    /// After a frame: a log line, the first time, where the processor had to draw it. Throws InputError where
    /// only a card may.
    void check(const RenderStatistics& statistics);

  private:
    DeviceChoice choice_;
    struct State;
    std::unique_ptr<State> state_;
    std::string said_;
};

/// Keeps with a frame what drew it, in an attribute of the file system's: the file's bytes are the same
/// whichever did. Where there are no such attributes, nothing is kept.
void note_device(const fs::path& frame, const std::string& device);
/// Empty: not known.
std::string noted_device(const fs::path& frame);

}  // namespace astrosplat
