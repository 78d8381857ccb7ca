#pragma once

#include <string>
#include <vector>

#include "exitance/base/checkpoint.hpp"

namespace exitance {

/// Stores every state; optionally starts from a given one.
class AllStates final : public CheckpointStore {
  public:
    explicit AllStates(std::string begin = {}) : begin_(std::move(begin)) {}
    bool is_due() const override { return true; }
    void keep(std::string state) override { states.push_back(std::move(state)); }
    std::string resumed() override { return begin_; }

    std::vector<std::string> states;

  private:
    std::string begin_;
};

}  // namespace exitance
