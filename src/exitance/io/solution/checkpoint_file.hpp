#pragma once

#include <string>
#include <utility>
#include <vector>

#include "exitance/core/checkpoint.hpp"
#include "exitance/core/result.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// What a checkpoint is of, by name: a run goes on from it only where all of this is the same.
using CheckpointFacts = std::vector<std::pair<std::string, std::string>>;

/// A hash of all that the light of a scene depends on, and of the numbers of its faces, as text.
std::string scene_fingerprint(const Scene& scene);

/// The state of a solve in a file beside its result, with a checksum; replaced whole or not at all. Read by the program
/// that wrote it and on the same kind of machine only.
class CheckpointFile final : public CheckpointStore {
  public:
    /// The program's version and build are added to the facts. `every`: seconds from one checkpoint to the next;
    /// infinite: write none.
    CheckpointFile(std::string path, CheckpointFacts facts, double every);

    /// Reads the file, so that the solve goes on from there. False where there is none. An error (bad_input) names what
    /// the file is of and this run is not, or says that it is damaged.
    Result<bool> load();
    bool is_due() const override { return watch_.seconds() >= every_; }
    void keep(std::string state) override;
    std::string resumed() const override { return state_; }
    /// How the last writing went.
    const Result<void>& written() const { return written_; }
    void remove() const;

  private:
    std::string path_;
    CheckpointFacts facts_;
    double every_;
    Stopwatch watch_;
    std::string state_;
    Result<void> written_;
};

}  // namespace exitance
