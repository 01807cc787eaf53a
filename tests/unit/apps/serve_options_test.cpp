#include "services/config/serve_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace citymesh {
namespace {

using testing::HasSubstr;
using testing::Not;

ServeOptions from_database() {
  ServeOptions options;
  options.source = "postgresql://reader@db.test/city";
  return options;
}

std::string refusal_of(const ServeOptions& options) {
  const auto checked = check(options);
  EXPECT_FALSE(checked);
  if (checked) return {};
  EXPECT_EQ(checked.error().code, ErrorCode::InvalidArgument);
  return checked.error().message;
}

TEST(ServeOptionsTest, WritingBackNeedsADatabaseThatIsReadAndAnotherSchema) {
  auto options = from_database();
  options.write_back_schema = "healed";
  EXPECT_TRUE(check(options));
  options.write_back_url = "postgres://writer@db.test/healed";
  EXPECT_TRUE(check(options));

  options.write_back_schema = options.source_schema;
  EXPECT_THAT(refusal_of(options), HasSubstr("another schema than --source_schema"));

  options = from_database();
  options.write_back_schema = "healed";
  options.source = "https://wfs.test/";
  EXPECT_THAT(refusal_of(options), HasSubstr("only with a 3DCityDB in --source"));
  options.source.clear();
  options.data = ".";
  EXPECT_THAT(refusal_of(options), HasSubstr("only with a 3DCityDB in --source"));
}

TEST(ServeOptionsTest, TheUrlForWritingBackNeedsASchemaAndADatabase) {
  auto options = from_database();
  options.write_back_url = "postgresql://writer:secret@db.test/healed";
  const auto alone = refusal_of(options);
  EXPECT_THAT(alone, HasSubstr("--write_back_url is given without --write_back_schema"));
  EXPECT_THAT(alone, Not(HasSubstr("secret")));

  options.write_back_schema = "healed";
  options.write_back_url = "https://writer:secret@db.test/healed";
  const auto web = refusal_of(options);
  EXPECT_THAT(web, HasSubstr("--write_back_url is 'https://writer:***@db.test/healed'"));
  EXPECT_THAT(web, HasSubstr("expected postgresql://"));
}

TEST(ServeOptionsTest, TheSourceIsAFolderADatabaseOrAWfs) {
  auto options = from_database();
  EXPECT_TRUE(check(options));
  options.data = ".";
  EXPECT_THAT(refusal_of(options), HasSubstr("both given"));
  options.data.clear();
  options.source = "mysql://reader:secret@db.test/city";
  EXPECT_THAT(refusal_of(options), HasSubstr("'mysql://reader:***@db.test/city'"));
  options = from_database();
  options.source_schema.clear();
  EXPECT_THAT(refusal_of(options), HasSubstr("--source_schema"));
  options = from_database();
  options.source_connections = 0;
  EXPECT_THAT(refusal_of(options), HasSubstr("--source_connections"));
  options = from_database();
  options.source_timeout_s = -1;
  EXPECT_THAT(refusal_of(options), HasSubstr("--source_timeout_s"));
}

}  // namespace
}  // namespace citymesh
