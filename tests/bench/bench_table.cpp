// The benchmarks' results as the table of speed. In: a folder of Google Benchmark's JSON files,
// PROGRAM.CORES.json. Out: Markdown. Every figure is the median of its runs.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace {

using nlohmann::json;

class Results {
  public:
    explicit Results(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Median over the runs of `program`'s benchmark `name` on `cores` cores; NaN when there is none.
    double median(const std::string& program, int cores, const std::string& name,
                  const std::string& field) const {
        std::vector<double> values;
        std::ifstream in(folder_ / fmt::format("{}.{}.json", program, cores));
        if (in) {
            const json document = json::parse(in);
            for (const json& run : document["benchmarks"])
                if (run["run_type"] == "iteration" && !run.contains("error_occurred") &&
                    matches(run["name"], name) && run.contains(field))
                    values.push_back(run[field].get<double>());
        }
        std::sort(values.begin(), values.end());
        return values.empty() ? std::nan("") : values[values.size() / 2];
    }
    double milliseconds(const std::string& program, int cores, const std::string& name) const {
        return median(program, cores, name, "real_time");
    }

  private:
    // Google Benchmark appends "/iterations:4/real_time".
    static bool matches(const std::string& full, const std::string& name) {
        return full == name || full.rfind(name + "/", 0) == 0;
    }
    std::filesystem::path folder_;
};

struct Row {
    std::string work, target, measured, note;
};

constexpr double copy_bytes = 2.0 * 1073741824.0;

double copy_bandwidth(const Results& r, int cores) {
    return copy_bytes / r.milliseconds("memory", cores, "copy") * 1e-6;
}

std::string seconds(double ms) { return fmt::format("{:.2f} s", ms * 1e-3); }

/// "12.3 GB/s, 22 % of a copy": what arrays in and out, once each, make of the bandwidth.
std::string traffic(const Results& r, double gb_per_s) {
    return fmt::format("{:.1f} GB/s in and out, {:.0f} % of copying", gb_per_s,
                       100.0 * gb_per_s / copy_bandwidth(r, 2));
}

Row render_row(const Results& r, const std::string& work, const std::string& target, const std::string& name,
               double splats) {
    constexpr double splat_bytes = 40.0, picture_bytes = 1920.0 * 1080.0 * 16.0;
    const double ms = r.milliseconds("render", 2, "frame/" + name);
    return {work, target, seconds(ms),
            fmt::format("{:.0f} B a splat beyond the set, pictures included; {}",
                        r.median("render", 2, "frame/" + name, "extra_B"),
                        traffic(r, (splats * splat_bytes + picture_bytes) / ms * 1e-6))};
}

Row look_row(const Results& r, const std::string& work, const std::string& target, const std::string& name) {
    return {work, target, fmt::format("{:.0f} M/s", r.median("look", 2, "look/" + name, "M/s")),
            traffic(r, r.median("look", 2, "look/" + name, "GB/s"))};
}

Row generate_row(const Results& r, const std::string& work, const std::string& target,
                 const std::string& name) {
    const auto figure = [&](const char* field) { return r.median("generate", 2, name, field); };
    return {
        work, target, seconds(figure("real_time")),
        fmt::format("the first time, in fresh memory, {}; {:.1f} % kept, {:.0f} MiB beyond the kept set; {}",
                    seconds(figure("first_ms")), figure("kept_percent"), figure("extra_MiB"),
                    traffic(r, figure("GB/s")))};
}

Row bodies_row(const Results& r, const std::string& work, const std::string& target, int width) {
    const std::string name = fmt::format("bodies/{}", width);
    const auto figure = [&](const char* field) { return r.median("bodies", 2, name, field); };
    return {work, target, seconds(figure("real_time")),
            fmt::format("{:.2f} Mpx/s, {:.1f} M splats, {:.0f} B a texel ({:.0f} estimated)",
                        1e3 * figure("Mpx") / figure("real_time"), figure("Msplats"), figure("texel_B"),
                        figure("told_B"))};
}

Row file_row(const Results& r, const std::string& work, const std::string& target, const std::string& name) {
    const auto rate = [&](const char* action) {
        return 1e-6 * r.median("files", 2, name + "_" + action, "bytes_per_second");
    };
    return {
        work, target, fmt::format("{:.0f} / {:.0f} MB/s", rate("read"), rate("write")),
        fmt::format("{:.1f} / {:.1f} M splats/s; raw write to this disk {:.0f} MB/s",
                    r.median("files", 2, name + "_read", "M/s"), r.median("files", 2, name + "_write", "M/s"),
                    1e3 * r.median("memory", 2, "disk", "GB/s"))};
}

std::string speedup(const Results& r, const std::string& program, const std::string& name) {
    return fmt::format("{:.2f}", r.milliseconds(program, 1, name) / r.milliseconds(program, 2, name));
}

Row scaling_row(const Results& r) {
    return {"2 cores against 1: frame 10 M / 2.6 M splats, look plain / noise, generate", ">= 1.7 times",
            fmt::format("{} / {}, {} / {}, {}", speedup(r, "render", "frame/10M_5px_over"),
                        speedup(r, "render", "frame/2600k_26px_over"), speedup(r, "look", "look/plain"),
                        speedup(r, "look", "look/noise"), speedup(r, "generate", "ball_13k")),
            fmt::format("copying memory: {:.2f}", copy_bandwidth(r, 2) / copy_bandwidth(r, 1))};
}

Row dense_row(const Results& r) {
    const auto figure = [&](const char* name, const char* field) {
        return r.median("generate", 2, name, field);
    };
    const double many = figure("ball_1M", "real_time"), first = figure("ball_1M", "first_ms");
    return {
        "generate: the same with 1 M triangles", "<= 2 times as long",
        fmt::format("{:.2f} times", many / figure("ball_13k", "real_time")),
        fmt::format("{}; the first time, in fresh memory, {}, {:.2f} times; {:.0f} MiB beyond the kept set",
                    seconds(many), seconds(first), first / figure("ball_13k", "first_ms"),
                    figure("ball_1M", "extra_MiB"))};
}

Row sequence_row(const Results& r) {
    const auto figure = [&](const char* field) { return r.median("sequence", 2, "sequence", field); };
    return {"the same frame as 1st and as 500th of a sequence", "the same time; no memory growth",
            fmt::format("{:.1f} ms and {:.1f} ms; {:+.1f} MiB", figure("frame_1_ms"), figure("frame_500_ms"),
                        figure("growth_MiB")),
            fmt::format("0.2 M splats, 320 x 180; the very first, which takes its memory: {:.1f} ms",
                        figure("very_first_ms"))};
}

Row start_row(const Results& r) {
    const auto figure = [&](const char* field) { return r.median("sequence", 2, "batch_start", field); };
    return {"start of `--batch` on a cached set of 10 M splats to first pixel", "<= 1 s",
            seconds(figure("real_time")),
            fmt::format("whole program with a frame of 16 x 16 px; {:.2f} s until the frame begins, {:.1f} M "
                        "splats",
                        1e-3 * figure("before_frame_ms"), figure("Msplats"))};
}

std::vector<Row> rows(const Results& r) {
    return {
        render_row(r, "10 M splats, gaussian, 5 px across, over, 1920x1080", "<= 0.40 s", "10M_5px_over",
                   1e7),
        render_row(r, "2.6 M splats, gaussian, 26 px across, over", "<= 0.20 s", "2600k_26px_over", 2.6e6),
        render_row(r, "2.6 M splats, 26 px, add", "<= 0.30 s", "2600k_26px_add", 2.6e6),
        render_row(r, "44 M splats, 3 px across, screen", "<= 1.8 s, <= 64 B a splat", "44M_3px_screen",
                   4.4e7),
        sequence_row(r),
        look_row(r, "look applied, no noise", ">= 100 M/s", "plain"),
        look_row(r, "look applied, four-octave noise", ">= 50 M/s", "noise"),
        generate_row(r, "generate: 134 M positions, 13,000 triangles, 7 % kept",
                     "<= 4 s, <= 1 GiB beyond the kept set", "ball_13k"),
        dense_row(r),
        generate_row(r, "generate: 61 M positions on a two-triangle plane, 40 % kept and stored", "<= 2.5 s",
                     "plane_40_percent"),
        bodies_row(r, "bodies of a painted galaxy, 1920x1200, fitted", "<= 4 s", 1920),
        bodies_row(r, "the same at 3840x2400", "<= 4 times as long", 3840),
        file_row(r, "PDA read / write, 10 M splats", ">= 900 / >= 500 MB/s", "pda"),
        file_row(r, "PLY read / write", "memory or disk speed", "ply"),
        file_row(r, "`.splats` read / write", "memory or disk speed", "splats"),
        scaling_row(r),
        start_row(r),
    };
}

void print(const Results& r) {
    fmt::print(
        "Memory of this machine: copying {:.1f} GB/s (1 core {:.1f}), writing memory never used "
        "before {:.1f} GB/s.\n\n",
        copy_bandwidth(r, 2), copy_bandwidth(r, 1), r.median("memory", 2, "fresh_memory", "GB/s"));
    fmt::print("| work | target | measured | bandwidth and notes |\n|---|---|---|---|\n");
    for (const Row& row : rows(r))
        fmt::print("| {} | {} | {} | {} |\n", row.work, row.target, row.measured, row.note);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: bench_table FOLDER\n", stderr);
        return 2;
    }
    try {
        print(Results(argv[1]));
    } catch (const std::exception& error) {
        fmt::print(stderr, "bench_table: {}\n", error.what());
        return 1;
    }
}
