#include "workbench/commands/replay_comparison.h"

#include "engine/core/error.h"
#include "engine/core/output_file.h"
#include "haptics/recording/recording_reader.h"
#include "workbench/files/force_figure.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <memory>
#include <optional>

namespace touchstone {

namespace {

/// Row by row: what was recorded and what each comparison made of it.
class ComparisonCsv {
  public:
    ComparisonCsv(const std::filesystem::path& file, size_t compared) : file_(file) {
        text_ = "t,hip_x,hip_y,hip_z";
        const auto columns = [this](const std::string& suffix) {
            for (const char* name :
                 {"proxy_x", "proxy_y", "proxy_z", "force_x", "force_y", "force_z", "contacts"})
                text_ += "," + std::string(name) + suffix;
        };
        columns("");
        for (size_t i = 1; i <= compared; ++i)
            columns("_" + std::to_string(i));
        text_ += "\n";
    }

    void begin(const RecordedTick& tick) {
        number(tick.time);
        vector(tick.sample.inWorkspace());
        touch(tick.proxy, tick.force, tick.contacts);
    }
    void add(const HapticOutput& output) { touch(output.proxy, output.force, output.contacts); }
    void endRow() {
        constexpr size_t kAtOnce = 1 << 20; // bytes
        text_ += "\n";
        if (text_.size() < kAtOnce)
            return;
        file_.write(text_);
        text_.clear();
    }
    void commit() {
        file_.write(text_);
        file_.commit();
    }

  private:
    void touch(const glm::dvec3& proxy, const glm::dvec3& force, uint32_t contacts) {
        vector(proxy);
        vector(force);
        text_ += "," + std::to_string(contacts);
    }
    void vector(const glm::dvec3& v) {
        for (int axis = 0; axis < 3; ++axis) {
            text_ += ',';
            number(v[axis]);
        }
    }
    void number(double value) {
        std::array<char, 32> digits{};
        const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
        text_.append(digits.data(), end);
    }

    OutputFile file_;
    std::string text_;
};

/// The outputs of one block of ticks with one choice of settings; empty where a tick cannot be touched again.
class ChangedReplay {
  public:
    ChangedReplay(const ComparedSettings& change, const Replayer::Load& load)
        : replayer_(load, [&change](HapticSettings settings) {
              for (const auto& [name, value] : change.settings)
                  if (const std::string problem = setSetting(settings, name, value); !problem.empty())
                      throw Error("--compare", name, problem, "");
              return settings;
          }) {
        replayer_.begin(each_);
    }
    ChangedReplay(const ChangedReplay&) = delete;
    ChangedReplay& operator=(const ChangedReplay&) = delete;

    void take(const RecordingReader::Item& item) {
        block_ = std::get_if<RecordedTicks>(&item.item);
        outputs_.assign(block_ != nullptr ? block_->ticks.size() : 0, std::nullopt);
        replayer_.take(item);
    }
    [[nodiscard]] const std::vector<std::optional<HapticOutput>>& outputs() const { return outputs_; }

  private:
    const RecordedTicks* block_ = nullptr;
    std::vector<std::optional<HapticOutput>> outputs_;
    const Replayer::Each each_ = [this](const RecordedTick& tick, const HapticOutput& output, int64_t, bool) {
        outputs_[static_cast<size_t>(&tick - block_->ticks.data())] = output;
    };
    Replayer replayer_;
};

std::vector<std::string> titlesOf(const ReplayOptions& options) {
    std::vector<std::string> titles{"as recorded"};
    for (const ComparedSettings& change : options.compare)
        titles.push_back(change.text);
    return titles;
}

} // namespace

std::vector<ReplayComparison> compareReplay(const ReplayOptions& options, const Replayer::Load& load) {
    std::vector<ReplayComparison> compared;
    if (options.compare.empty() && options.plot.empty())
        return compared;
    std::vector<std::unique_ptr<ChangedReplay>> changed;
    for (const ComparedSettings& change : options.compare) {
        compared.push_back({change.text, {}});
        changed.push_back(std::make_unique<ChangedReplay>(change, load));
    }
    std::optional<ComparisonCsv> csv;
    if (!options.compareOut.empty())
        csv.emplace(options.compareOut, compared.size());
    ForceFigure figure(titlesOf(options));
    std::optional<double> begin;
    RecordingReader reader(options.recording);
    while (const std::optional<RecordingReader::Item> item = reader.next()) {
        for (const auto& replay : changed)
            replay->take(*item);
        const auto* const block = std::get_if<RecordedTicks>(&item->item);
        for (size_t i = 0; block != nullptr && i < block->ticks.size(); ++i) {
            const RecordedTick& tick = block->ticks[i];
            if (std::ranges::any_of(changed, [&](const auto& replay) { return !replay->outputs()[i]; }))
                continue; // behind a gap
            const double seconds = tick.time - begin.value_or(tick.time);
            begin = begin.value_or(tick.time);
            if (!options.plot.empty())
                figure.begin(seconds, glm::length(tick.force),
                             glm::distance(tick.proxy, tick.sample.inWorkspace()));
            if (csv)
                csv->begin(tick);
            for (size_t c = 0; c < changed.size(); ++c) {
                const HapticOutput& output = *changed[c]->outputs()[i];
                compared[c].figures.add(seconds, tick, output);
                if (!options.plot.empty())
                    figure.add(glm::length(output.force), glm::distance(output.proxy, output.hip));
                if (csv)
                    csv->add(output);
            }
            if (csv)
                csv->endRow();
        }
    }
    if (csv)
        csv->commit();
    if (!options.plot.empty())
        figure.draw(options.plot, options.recording.filename().string());
    return compared;
}

nlohmann::ordered_json comparisonsJson(const std::vector<ReplayComparison>& compared) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const ReplayComparison& one : compared) {
        nlohmann::ordered_json json{{"settings", one.settings}};
        json.update(one.figures.json());
        all.push_back(std::move(json));
    }
    return all;
}

void printComparisons(const std::vector<ReplayComparison>& compared) {
    for (const ReplayComparison& one : compared) {
        const ForceComparison& figures = one.figures;
        if (figures.ticks() == 0) {
            std::printf("%s\n", figures.text("with " + one.settings).c_str());
            continue;
        }
        const ForceComparison::Side then = figures.recorded(), now = figures.other();
        std::printf("%s, over %llu ticks in contact with either\n", one.settings.c_str(),
                    static_cast<unsigned long long>(figures.ticks()));
        std::printf("  %-12s %8s %8s %12s\n", "", "mean, N", "max, N", "in contact");
        for (const auto& [name, side] : {std::pair("as recorded", then), std::pair("changed", now)})
            std::printf("  %-12s %8.3f %8.3f %12llu\n", name, side.mean, side.max,
                        static_cast<unsigned long long>(side.contactTicks));
        std::printf("  %-12s %8.3f %8.3f at %.3f s; proxies at most %.3f mm apart\n", "difference",
                    figures.meanDifference(), figures.maxDifference(), figures.maxDifferenceAt(),
                    1e3 * figures.maxProxyDistance());
    }
}

} // namespace touchstone
