// SPDX-License-Identifier: GPL-3.0-or-later
// What hilo-advise found, as tables, JSON, CSV and rules for hilo-tag.
#pragma once
#include "advise/search.hpp"

namespace hilo {

std::string report_text(const Candidates& all, const Advice& advice);
std::string report_json(const Candidates& all, const Advice& advice);
/// Every model that ran, for a chart of cost against error: model, choice, seconds, error.
std::string models_csv(const Candidates& all, const Advice& advice);
/// What each region that was tried rigid adds to the error, for `hilo-post model --values`: region, error over allowed.
std::string regions_csv(const Candidates& all, const Advice& advice);
/// tags.toml of the chosen model; what it cannot say, stiffening, is a comment for the scene.
std::string rules(const Candidates& all, const Advice& advice, const std::string& command);

}  // namespace hilo
