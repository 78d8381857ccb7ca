#pragma once

#include <optional>
#include <vector>

#include "exitance/cli/view/view_server.hpp"

namespace exitance {

/// The parameter `name` of a request by the viewer's page; empty if it is missing.
std::string view_text(const ViewServer::Parameters& parameters, const std::string& name);

/// The numbers of the parameter `name`, separated by commas and below 1e12 in magnitude; none if they are not exactly
/// `count` numbers.
std::optional<std::vector<double>> view_numbers(const ViewServer::Parameters& parameters, const std::string& name,
                                                std::size_t count);

/// Answer to a malformed request.
inline const ViewAnswer view_misunderstood{400, "text/plain", "not understood"};
/// Answer while a scene has no light yet. Pages cannot avoid such requests, and browsers log a status of 400 or above
/// as an error.
inline const ViewAnswer view_absent{204, "text/plain", ""};

}  // namespace exitance
