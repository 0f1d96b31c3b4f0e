#include "edit/settings.h"

namespace astrosplat {
namespace {

constexpr SettingChoice scales[] = {{0, "Auto"},    {100, "100 %"}, {125, "125 %"},
                                    {150, "150 %"}, {200, "200 %"}, {300, "300 %"}};
constexpr SettingChoice threads[] = {{0, "All"}, {1, "1"},   {2, "2"},  {4, "4"},
                                     {8, "8"},   {16, "16"}, {32, "32"}};
constexpr SettingChoice caches[] = {{0, "Auto"},    {5, "5 GiB"},     {20, "20 GiB"},
                                    {50, "50 GiB"}, {100, "100 GiB"}, {500, "500 GiB"}};
constexpr SettingChoice autosaves[] = {{15, "15 s"}, {30, "30 s"}, {60, "1 min"}, {300, "5 min"}};
constexpr SettingChoice settles[] = {{1, "Goes on to the final frame"}, {0, "Stays a preview"}};
constexpr SettingChoice engines[] = {{0, "Auto"}, {1, "OpenGL"}, {2, "Processor"}};

constexpr SettingRow rows[] = {
    {"interface_percent", "Interface", "Size of text and controls; Auto: as the screen asks",
     &Settings::interface_percent, scales},
    {"settles", "View at rest", "How views begin; View > Settle changes the one that is open",
     &Settings::settles, settles},
    {"engine", "Preview by", "How views begin; the tools' Engine changes the one that is open",
     &Settings::engine, engines},
    {"threads", "Threads", "From the next start; --threads wins", &Settings::threads, threads},
    {"cache_gib", "Cache",
     "Most that generated sets may take, from the next start; Auto: 20 GiB or a tenth of the disk",
     &Settings::cache_gib, caches},
    {"autosave_s", "Autosave", "How soon an edit is safe from a crash, from the next start",
     &Settings::autosave_s, autosaves}};

}  // namespace

std::span<const SettingRow> setting_rows() { return rows; }

}  // namespace astrosplat
