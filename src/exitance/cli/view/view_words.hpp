#pragma once

#include <optional>
#include <vector>

#include "exitance/cli/view/view_server.hpp"

namespace exitance {

/// What a request of the viewer's page says by a name; empty where it says nothing.
std::string view_text(const ViewServer::Parameters& parameters, const std::string& name);

/// Finite numbers between commas; none where there are not `count` of them.
std::optional<std::vector<double>> view_numbers(const ViewServer::Parameters& parameters, const std::string& name,
                                                std::size_t count);

inline const ViewAnswer view_misunderstood{400, "text/plain", "not understood"};
/// There is no light yet. A page asks before it knows; browsers would log a status of 400 or above as an error.
inline const ViewAnswer view_absent{204, "text/plain", ""};

}  // namespace exitance
