#include "core/write/drawing.h"

#include <algorithm>
#include <cmath>

#include "core/write/text.h"

namespace citymesh {
namespace {

constexpr int kShades = 14;
constexpr std::size_t kKinds = 3;

/// Smaller than half a pixel in both directions.
bool is_speck(const Outline& outline) {
  constexpr std::int64_t kSpeck_tenths = 5;
  auto low = outline[0], high = outline[0];
  for (const auto& at : outline)
    for (std::size_t i = 0; i < 2; ++i) {
      low[i] = std::min(low[i], at[i]);
      high[i] = std::max(high[i], at[i]);
    }
  return high[0] - low[0] < kSpeck_tenths && high[1] - low[1] < kSpeck_tenths;
}

Colour mix(const Colour& a, const Colour& b, double share_of_b) {
  Colour c{};
  for (std::size_t i = 0; i < 3; ++i)
    c[i] = static_cast<std::uint8_t>(std::lround(a[i] + (b[i] - a[i]) * share_of_b));
  return c;
}

int shade_of(const Point3& normal) {
  const double light = std::max(0.0, dot(normal, kSun));
  return static_cast<int>(std::lround(light * (kShades - 1)));
}

Colour fill_of(const DrawnFace& face) {
  return shaded(kStyles[face.style].colour, face.kind,
                static_cast<double>(shade_of(face.normal)) / (kShades - 1));
}

/// Class of a face: style letter, kind letter, shade number. "cw7"
std::string class_of(std::size_t style, DrawnFace::Kind kind, int shade) {
  std::string name;
  name += static_cast<char>('a' + style);
  name += kind == DrawnFace::Kind::Wall ? 'w' : kind == DrawnFace::Kind::Roof ? 'r' : 'o';
  append_integer(name, shade);
  return name;
}

/// Those edges of a triangle that are edges of the whole face.
std::string face_edges(const Page& page, const PaintFace& face, std::int32_t triangle) {
  std::string path;
  const auto& corners = face.triangles[static_cast<std::size_t>(triangle)];
  for (std::size_t i = 0; i < 3; ++i) {
    const Point3 &a = corners[i], &b = corners[(i + 1) % 3];
    for (const auto& ring : face.rings)
      for (std::size_t j = 0; j < ring.size(); ++j) {
        if (!(ring[j] == a) || !(ring[(j + 1) % ring.size()] == b)) continue;
        append_segment(path, page.tenths(a), page.tenths(b));
      }
  }
  return path;
}

}  // namespace

DrawnFace::Corner corner_of(const GridPoint& p) {
  return {static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y),
          static_cast<std::int32_t>(p.z)};
}

Point3 metres(const DrawnFace::Corner& c) {
  return {c[0] / kGridStepsPerMetre, c[1] / kGridStepsPerMetre, c[2] / kGridStepsPerMetre};
}

double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

std::array<std::int64_t, 2> Page::tenths(const Point3& view) const {
  return {std::llround(10 * (left + scale * view.x)),
          std::llround(10 * (top - scale * screen_y(view)))};
}

void append_segment(std::string& svg, const std::array<std::int64_t, 2>& from,
                    const std::array<std::int64_t, 2>& to) {
  svg += 'M';
  append_tenths(svg, from[0]);
  svg += ' ';
  append_tenths(svg, from[1]);
  svg += 'L';
  append_tenths(svg, to[0]);
  svg += ' ';
  append_tenths(svg, to[1]);
}

void append_tenths(std::string& out, std::int64_t tenths) {
  if (tenths < 0) out += '-';
  const std::int64_t magnitude = tenths < 0 ? -tenths : tenths;
  append_integer(out, magnitude / 10);
  if (magnitude % 10 != 0) {
    out += '.';
    out += static_cast<char>('0' + magnitude % 10);
  }
}

void append_px(std::string& out, double px) { append_tenths(out, std::llround(10 * px)); }

Outline outline_of(const Page& page, std::span<const Point3> ring) {
  Outline outline;
  for (const Point3& p : ring) {
    const auto at = page.tenths(p);
    if (outline.empty() || outline.back() != at) outline.push_back(at);
  }
  while (outline.size() > 1 && outline.front() == outline.back()) outline.pop_back();
  if (outline.size() < 3 || is_speck(outline)) outline.clear();
  return outline;
}

void append_outline(std::string& out, const Outline& outline) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    auto [x, y] = outline[i];
    out += i == 0 ? 'M' : i == 1 ? 'l' : ' ';
    if (i > 0) {
      x -= outline[i - 1][0];
      y -= outline[i - 1][1];
    }
    append_tenths(out, x);
    if (y >= 0) out += ' ';
    append_tenths(out, y);
  }
  if (!outline.empty()) out += 'z';
}

Colour shaded(const Colour& base, DrawnFace::Kind kind, double light) {
  constexpr Colour kShade{52, 62, 92}, kWhite{255, 255, 252}, kGlass{64, 88, 112};
  switch (kind) {
    case DrawnFace::Kind::Wall:
      return mix(mix(base, kShade, 0.46), mix(base, kWhite, 0.12), light);
    case DrawnFace::Kind::Roof:
      return mix(mix(base, kShade, 0.20), mix(base, kWhite, 0.72), light);
    case DrawnFace::Kind::Opening:
      return mix(mix(kGlass, kShade, 0.35), mix(kGlass, kWhite, 0.25), light);
  }
  return base;
}

void append_colour(std::string& out, const Colour& colour) {
  constexpr std::string_view kHex = "0123456789abcdef";
  out += '#';
  for (const std::uint8_t c : colour) {
    out += kHex[c >> 4];
    out += kHex[c & 15];
  }
}

void Looks::add(std::span<const DrawnFace> faces) {
  used_.resize(kStyles.size() * kKinds * kShades, 0);
  for (const DrawnFace& face : faces)
    used_[(face.style * kKinds + static_cast<std::size_t>(face.kind)) * kShades +
          static_cast<std::size_t>(shade_of(face.normal))] = 1;
}

std::string Looks::css(std::string_view selector, double stroke_px) const {
  std::string css(selector);
  css += " .f path{stroke-width:";
  append_number(css, stroke_px, 2);
  css += ";stroke-linejoin:round;fill-rule:evenodd}";
  for (std::size_t i = 0; i < used_.size(); ++i) {
    if (used_[i] == 0) continue;
    const auto kind = static_cast<DrawnFace::Kind>(i / kShades % kKinds);
    const int shade = static_cast<int>(i % kShades);
    const std::size_t style = i / kShades / kKinds;
    const Colour fill =
        shaded(kStyles[style].colour, kind, static_cast<double>(shade) / (kShades - 1));
    css += selector;
    css += " .";
    css += class_of(style, kind, shade);
    css += "{fill:";
    append_colour(css, fill);
    css += ";stroke:";
    append_colour(css, mix(fill, {38, 44, 62}, 0.42));
    css += '}';
  }
  return css;
}

void append_faces(std::string& svg, const Page& page, std::span<const DrawnFace> all) {
  std::vector<PaintFace> faces;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const DrawnFace& drawn = all[i];
    PaintFace face;
    face.normal = to_view(drawn.normal);
    if (towards_viewer(face.normal) <= 1e-6) continue;
    face.paint = i;
    for (const auto& ring : drawn.rings) {
      auto& corners = face.rings.emplace_back();
      for (const auto& corner : ring) corners.push_back(to_view(metres(corner)));
    }
    for (const auto& triangle : drawn.triangles)
      face.triangles.push_back({to_view(metres(triangle[0])), to_view(metres(triangle[1])),
                                to_view(metres(triangle[2]))});
    faces.push_back(std::move(face));
  }

  svg += "<g class=\"f\">\n";
  for (const PaintStep& step : painting_order(faces)) {
    const PaintFace& face = faces[step.face];
    const DrawnFace& drawn = all[face.paint];
    std::string path;
    if (step.triangle < 0) {
      for (const auto& ring : face.rings) append_outline(path, outline_of(page, ring));
    } else {
      append_outline(path,
                     outline_of(page, face.triangles[static_cast<std::size_t>(step.triangle)]));
    }
    if (path.empty()) continue;
    svg += "<path class=\"" + class_of(drawn.style, drawn.kind, shade_of(drawn.normal));
    if (step.triangle < 0) {
      svg += "\" d=\"" + path + "\"/>\n";
      continue;
    }
    // A piece of a face: its stroke hides the seam to the next piece, edges of the face come on
    // top.
    svg += "\" style=\"stroke-width:.9;stroke:";
    append_colour(svg, fill_of(drawn));
    svg += "\" d=\"" + path + "\"/>\n";
    const std::string edges = face_edges(page, face, step.triangle);
    if (!edges.empty())
      svg += "<path class=\"" + class_of(drawn.style, drawn.kind, shade_of(drawn.normal)) +
             "\" style=\"fill:none\" d=\"" + edges + "\"/>\n";
  }
  svg += "</g>\n";
}

}  // namespace citymesh
