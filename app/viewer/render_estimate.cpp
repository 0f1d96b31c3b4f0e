#include "viewer/render_estimate.h"

#include <fmt/format.h>

#include <regex>

namespace astrosplat {

std::string estimate_text(const std::vector<std::string>& lines) {
    static const std::regex frames(R"(frames (\d+): (\d+) to render, (\d+) there already)"),
        cost("(time|files) about .*, (.*) in all");
    std::string costs, there;
    std::smatch parts;
    for (const std::string& line : lines) {
        if (line.starts_with("kept ")) return "A movie of these very frames is there already";
        if (std::regex_match(line, parts, frames)) {
            if (parts[2] == "0") return "All frames are there already";
            if (parts[3] != "0")
                there = fmt::format("; {} of {} frames are there already", parts[3].str(), parts[1].str());
        } else if (std::regex_match(line, parts, cost)) {
            costs += (costs.empty() ? "About " : " and ") + parts[2].str();
        }
    }
    return costs.empty() ? "" : costs + " in all" + there;
}

void RenderEstimate::stop() {
    if (run_) {
        run_->cancel();
        leaving_.push_back(std::move(run_));
    }
    std::erase_if(leaving_, [](const std::unique_ptr<RenderJob>& job) {
        job->poll();
        return job->state() != RenderJob::State::running;
    });
    asked_.reset();
    waits_ = false;
    text_.clear();
}

void RenderEstimate::want(const RenderQueue& jobs, const RenderTask& task, const Document& document,
                          double now) {
    constexpr double rest_s = 0.4;  // while a person types
    if (asked_ != std::pair(document.revision(), task)) {
        stop();
        asked_ = {document.revision(), task};
        since_ = now;
        waits_ = render_problem(task, document.scene().camera).empty() && !renders_by_slurm(task);
    }
    if (waits_ && now - since_ >= rest_s) {
        waits_ = false;
        JobPlan plan = jobs.plan_of(task, document);
        plan.steps.resize(1);
        plan.steps[0].arguments.push_back("--dry-run");
        plan.movie.clear();
        plan.keeps_lines = true;
        run_ = std::make_unique<RenderJob>(std::move(plan));
    }
    if (!run_) return;
    run_->poll();
    if (run_->state() == RenderJob::State::running) return;
    text_ = run_->state() == RenderJob::State::done ? estimate_text(run_->lines()) : run_->text();
    run_.reset();
}

}  // namespace astrosplat
