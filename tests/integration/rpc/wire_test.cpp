#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>

#include "citymesh/v1/error_details.pb.h"
#include "citymesh/v1/jobs.pb.h"

namespace citymesh {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FileDescriptor;

/// All that a client of any age relies on, a line each.
std::set<std::string> wire_of(const FileDescriptor& file) {
  std::set<std::string> lines;
  for (int m = 0; m < file.message_type_count(); ++m) {
    const Descriptor& message = *file.message_type(m);
    for (int f = 0; f < message.field_count(); ++f) {
      const auto& field = *message.field(f);
      const std::string type = field.message_type() ? field.message_type()->name()
                               : field.enum_type()  ? field.enum_type()->name()
                                                    : field.type_name();
      lines.insert(message.name() + ' ' + std::to_string(field.number()) + ' ' + field.name() +
                   (field.is_repeated() ? " repeated " : " ") + type);
    }
  }
  for (int e = 0; e < file.enum_type_count(); ++e) {
    const EnumDescriptor& type = *file.enum_type(e);
    for (int v = 0; v < type.value_count(); ++v)
      lines.insert(type.name() + ' ' + std::to_string(type.value(v)->number()) + ' ' +
                   type.value(v)->name());
  }
  for (int s = 0; s < file.service_count(); ++s)
    for (int c = 0; c < file.service(s)->method_count(); ++c) {
      const auto& call = *file.service(s)->method(c);
      lines.insert(call.full_name() + '(' + call.input_type()->name() + ") " +
                   (call.server_streaming() ? "stream " : "") + call.output_type()->name());
    }
  return lines;
}

TEST(Wire, WhatClientsOfAnyAgeRelyOnNeverChanges) {
  auto present = wire_of(*v1::Job::descriptor()->file());
  present.merge(wire_of(*v1::Status::descriptor()->file()));
  std::set<std::string> stored;
  std::ifstream file(std::string(CITYMESH_TEST_DATA) + "/wire/jobs.txt");
  ASSERT_TRUE(file);
  for (std::string line; std::getline(file, line);)
    if (!line.empty() && line[0] != '#') stored.insert(line);
  for (const auto& line : stored)
    EXPECT_TRUE(present.contains(line)) << "gone or changed, which breaks clients: " << line;
  for (const auto& line : present)
    EXPECT_TRUE(stored.contains(line)) << "new; add it to tests/data/wire/jobs.txt: " << line;
}

}  // namespace
}  // namespace citymesh
