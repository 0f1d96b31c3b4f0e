// Unsaved edits survive a crash: a copy of the scene in the person's state folder, and the way back from it.
// In: the document, once a frame. Out: files NAME-PID-HASH.toml that any astrosplat can load, whose first
// line says what they are of.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "edit/document.h"
#include "edit/settings.h"

namespace astrosplat {

/// state_folder()/autosave; empty without a home.
std::filesystem::path autosave_folder();

/// As the settings say; $ASTROSPLAT_AUTOSAVE_SECONDS, 1 to 3600, where it says otherwise (for tests).
std::chrono::seconds autosave_interval(const Settings& settings = {});

/// Owns the autosave of one window. A folder that cannot be written costs one warning, nothing else.
class Autosave {
  public:
    using Clock = std::chrono::steady_clock;
    explicit Autosave(std::filesystem::path folder = autosave_folder(),
                      Clock::duration every = autosave_interval());
    /// Removes the file: the window was closed in peace. While an exception ends the program it stays.
    ~Autosave();
    Autosave(const Autosave&) = delete;
    Autosave& operator=(const Autosave&) = delete;

    /// To be called often; cheap. Writes `every` (a minute) after the first edit that is not in the
    /// file, and removes the file when there is nothing left to save.
    void update(const Document& document, Clock::time_point now = Clock::now());
    /// Writes at once. False where it cannot.
    bool write(const Document& document);
    void remove();
    /// Empty while there is none.
    const std::filesystem::path& file() const { return file_; }

  private:
    std::filesystem::path folder_, file_;
    Clock::duration every_;
    std::unique_ptr<FileLock> lock_;  // says to others that this process lives
    std::uint64_t written_ = 0;       // revision in the file
    Clock::time_point changed_{};     // first update() that saw a newer one
    bool waiting_ = false;
};

/// An autosave whose process is gone.
struct Recovery {
    std::filesystem::path autosave;
    std::filesystem::path original;  // the scene's file, or where an untitled one was
    bool titled = true;
    std::string time;  // UTC, "2026-05-01 12:30:00"

    std::string name() const;  // "whirlpool.toml", "m51 (never saved)"
};

/// Newest first. Never throws: a folder that cannot be read holds none.
std::vector<Recovery> recoveries(const std::filesystem::path& folder = autosave_folder());
/// The document as it was; it is edited(), saving writes the original. The autosave stays until
/// discard_recovery(): write a new one (Autosave::write) first. Throws InputError.
Document recover(const std::filesystem::path& autosave);
void discard_recovery(const std::filesystem::path& autosave);

}  // namespace astrosplat
