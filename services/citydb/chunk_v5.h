#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "services/citydb/feature_builder.h"
#include "services/citydb/schema.h"

namespace citymesh::citydb {

/// Schema::fetch() and Schema::build() of version 5: three exchanges with the database (what the
/// buildings contain; all that these features have; the templates of implicit geometry).
Result<Tables> fetch_v5(postgres::Connection& connection, std::vector<std::int64_t> ids,
                        const std::stop_token& stop);
Result<void> build_v5(const Tables& tables, const Instance& instance, FeatureBuilder& builder,
                      const source::FeatureSink& sink);

}  // namespace citymesh::citydb
