#include "core/write/picture.h"

#include <algorithm>
#include <cmath>

#include "core/write/painter.h"
#include "core/write/text.h"

namespace citymesh {
namespace {

constexpr double kWidth = 1400;
constexpr double kMargin = 40;
constexpr double kTitleHeight = 96;
constexpr double kFooterHeight = 84;
constexpr double kMinScene = 420, kMaxScene = 900;  // height of the scene
constexpr int kShades = 14;

Point3 metres(const DrawnFace::Corner& c) {
  return {c[0] / kGridStepsPerMetre, c[1] / kGridStepsPerMetre, c[2] / kGridStepsPerMetre};
}

double dot(const Point3& a, const Point3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// From view space to the page: tenths of a pixel, y down.
struct Page {
  double scale = 1;  ///< pixels in a metre
  double left = 0, top = 0;

  std::array<std::int64_t, 2> tenths(const Point3& view) const {
    return {std::llround(10 * (left + scale * view.x)),
            std::llround(10 * (top - scale * screen_y(view)))};
  }
};

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

using Outline = std::vector<std::array<std::int64_t, 2>>;

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

/// Page outline of a ring without repeated points; empty when nothing is left to see.
template <class Ring>
Outline outline_of(const Page& page, const Ring& ring) {
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

// ---- colours ----

using Colour = std::array<std::uint8_t, 3>;

Colour mix(const Colour& a, const Colour& b, double share_of_b) {
  Colour c{};
  for (std::size_t i = 0; i < 3; ++i)
    c[i] = static_cast<std::uint8_t>(std::lround(a[i] + (b[i] - a[i]) * share_of_b));
  return c;
}

/// `light` from 0 (in the shade) to 1 (full sun): shade turns bluish, sun turns white.
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

/// Class of a face: rung letter, kind letter, shade number. "cw7"
std::string class_of(std::size_t rung, DrawnFace::Kind kind, int shade) {
  std::string name;
  name += static_cast<char>('a' + rung);
  name += kind == DrawnFace::Kind::Wall ? 'w' : kind == DrawnFace::Kind::Roof ? 'r' : 'o';
  append_integer(name, shade);
  return name;
}

int shade_of(const Point3& normal) {
  const double light = std::max(0.0, dot(normal, kSun));
  return static_cast<int>(std::lround(light * (kShades - 1)));
}

Colour fill_of(const DrawnFace& face) {
  return shaded(rung_style(face.rung).colour, face.kind,
                static_cast<double>(shade_of(face.normal)) / (kShades - 1));
}

std::string style(const std::vector<DrawnFace>& faces, double stroke) {
  constexpr std::size_t kKinds = 3;
  std::vector<char> used((kRungStyles.size() + 1) * kKinds * kShades, 0);
  for (const DrawnFace& face : faces)
    used[(face.rung * kKinds + static_cast<std::size_t>(face.kind)) * kShades +
         static_cast<std::size_t>(shade_of(face.normal))] = 1;
  std::string css = "<style>#citymesh-picture .f path{stroke-width:";
  append_number(css, stroke, 2);
  css += ";stroke-linejoin:round;fill-rule:evenodd}";
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] == 0) continue;
    const auto kind = static_cast<DrawnFace::Kind>(i / kShades % kKinds);
    const int shade = static_cast<int>(i % kShades);
    const std::size_t rung = i / kShades / kKinds;
    const Colour fill =
        shaded(rung_style(rung).colour, kind, static_cast<double>(shade) / (kShades - 1));
    css += "#citymesh-picture .";
    css += class_of(rung, kind, shade);
    css += "{fill:";
    append_colour(css, fill);
    css += ";stroke:";
    append_colour(css, mix(fill, {38, 44, 62}, 0.42));
    css += '}';
  }
  return css + "</style>\n";
}

// ---- ground ----

/// A plane through the feet of the bodies, by least squares; level when they do not tell.
struct GroundPlane {
  double z0 = 0, x = 0, y = 0;
  double at(double px, double py) const { return z0 + x * px + y * py; }
};

GroundPlane ground_plane(const std::vector<DrawnBlock>& blocks) {
  if (blocks.empty()) return {};
  double n = 0, mx = 0, my = 0, mz = 0;
  std::vector<Point3> feet;
  for (const DrawnBlock& block : blocks) {
    feet.push_back(metres(DrawnFace::Corner{block.outline[0][0], block.outline[0][1], block.base}));
    mx += feet.back().x;
    my += feet.back().y;
    mz += feet.back().z;
    ++n;
  }
  mx /= n, my /= n, mz /= n;
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0;
  for (const Point3& p : feet) {
    const double x = p.x - mx, y = p.y - my, z = p.z - mz;
    xx += x * x, xy += x * y, yy += y * y, xz += x * z, yz += y * z;
  }
  const double determinant = xx * yy - xy * xy;
  GroundPlane plane{mz, 0, 0};
  constexpr double kSteepest = 0.3;
  if (n >= 8 && determinant > 1e-6 * (xx + yy) * (xx + yy)) {
    plane.x = std::clamp((xz * yy - yz * xy) / determinant, -kSteepest, kSteepest);
    plane.y = std::clamp((yz * xx - xz * xy) / determinant, -kSteepest, kSteepest);
    plane.z0 = mz - plane.x * mx - plane.y * my;
  }
  // Few feet may stand below the ground, or it would seem to float over them.
  std::vector<double> above;
  for (const Point3& p : feet) above.push_back(p.z - plane.at(p.x, p.y));
  const auto low = above.begin() + static_cast<std::ptrdiff_t>(above.size() / 20);
  std::nth_element(above.begin(), low, above.end());
  plane.z0 += std::min(0.0, *low);
  return plane;
}

/// 1, 2 or 5 times a power of ten, not above `value`.
double round_length(double value) {
  double length = 1e-3;
  while (length * 10 <= value) length *= 10;
  if (length * 5 <= value) return length * 5;
  return length * 2 <= value ? length * 2 : length;
}

void append_text(std::string& svg, double x, double y, std::string_view classes,
                 std::string_view text) {
  svg += "<text x=\"";
  append_px(svg, x);
  svg += "\" y=\"";
  append_px(svg, y);
  svg += "\" class=\"";
  svg += classes;
  svg += "\">";
  append_markup(svg, text);
  svg += "</text>\n";
}

std::string grouped_digits(std::uint64_t value) {
  std::string text = std::to_string(value);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, "\u202f");
  return text;
}

/// All that is drawn, in view space, and where on the page.
struct Drawing {
  std::vector<DrawnFace> faces{};
  std::array<Point3, 4> plate{};  ///< corners of the ground: south-west, south-east, …
  double plate_depth_m = 0;
  Box3 plan{};  ///< of the ground, metres
  GroundPlane ground{};
  Page page{};
  double height = 0;
};

Drawing lay_out(std::vector<DrawnFace> faces, const std::vector<DrawnBlock>& blocks) {
  Drawing drawing;
  drawing.faces = std::move(faces);
  drawing.ground = ground_plane(blocks);
  for (const DrawnFace& face : drawing.faces)
    for (const auto& ring : face.rings)
      for (const auto& corner : ring) drawing.plan.add(metres(corner));
  if (drawing.plan.is_empty()) drawing.plan = {{-50, -35, 0}, {50, 35, 0}};
  Box3& plan = drawing.plan;
  const double span = std::max(plan.max.x - plan.min.x, plan.max.y - plan.min.y);
  const double border = std::max(4.0, 0.05 * span);
  plan.min.x -= border, plan.min.y -= border, plan.max.x += border, plan.max.y += border;
  drawing.plate_depth_m = 0.018 * (span + 2 * border);

  const auto on_ground = [&](double x, double y) {
    return to_view({x, y, drawing.ground.at(x, y)});
  };
  drawing.plate = {on_ground(plan.min.x, plan.min.y), on_ground(plan.max.x, plan.min.y),
                   on_ground(plan.max.x, plan.max.y), on_ground(plan.min.x, plan.max.y)};

  Box3 seen;  // x and screen y
  for (Point3 p : drawing.plate) {
    seen.add(Point3{p.x, screen_y(p), 0});
    p.z -= drawing.plate_depth_m;
    seen.add(Point3{p.x, screen_y(p), 0});
  }
  for (const DrawnFace& face : drawing.faces)
    for (const auto& ring : face.rings)
      for (const auto& corner : ring) {
        const Point3 p = to_view(metres(corner));
        seen.add(Point3{p.x, screen_y(p), 0});
      }
  const double wide = seen.max.x - seen.min.x, high = seen.max.y - seen.min.y;
  Page& page = drawing.page;
  page.scale = std::min((kWidth - 2 * kMargin) / wide, kMaxScene / high);
  const double scene = std::clamp(page.scale * high, kMinScene, kMaxScene);
  page.left = kWidth / 2 - page.scale * (seen.min.x + seen.max.x) / 2;
  page.top = kTitleHeight + scene / 2 + page.scale * (seen.min.y + seen.max.y) / 2;
  drawing.height = kTitleHeight + scene + kFooterHeight;
  return drawing;
}

void append_ground(std::string& svg, const Drawing& drawing) {
  const Page& page = drawing.page;
  const auto& plate = drawing.plate;
  const auto lowered = [&](Point3 p) {
    p.z -= drawing.plate_depth_m;
    return p;
  };
  // The sides towards the viewer: south and west.
  svg += "<path fill=\"#b9bdb8\" d=\"";
  append_outline(
      svg, outline_of(page, std::array{plate[0], plate[1], lowered(plate[1]), lowered(plate[0])}));
  svg += "\"/>\n<path fill=\"#9da3a1\" d=\"";
  append_outline(
      svg, outline_of(page, std::array{plate[3], plate[0], lowered(plate[0]), lowered(plate[3])}));
  svg += "\"/>\n<path fill=\"#e4e6de\" d=\"";
  append_outline(svg, outline_of(page, plate));
  svg += "\"/>\n";

  const Box3& plan = drawing.plan;
  const double step = round_length(std::max(plan.max.x - plan.min.x, plan.max.y - plan.min.y) / 4);
  svg += "<path fill=\"none\" stroke=\"#fff\" stroke-opacity=\".75\" d=\"";
  const auto line = [&](double x1, double y1, double x2, double y2) {
    const auto a = page.tenths(to_view({x1, y1, drawing.ground.at(x1, y1)}));
    const auto b = page.tenths(to_view({x2, y2, drawing.ground.at(x2, y2)}));
    svg += 'M';
    append_tenths(svg, a[0]);
    svg += ' ';
    append_tenths(svg, a[1]);
    svg += 'L';
    append_tenths(svg, b[0]);
    svg += ' ';
    append_tenths(svg, b[1]);
  };
  for (double x = std::ceil(plan.min.x / step) * step; x <= plan.max.x; x += step)
    line(x, plan.min.y, x, plan.max.y);
  for (double y = std::ceil(plan.min.y / step) * step; y <= plan.max.y; y += step)
    line(plan.min.x, y, plan.max.x, y);
  svg += "\"/>\n";
}

/// What the sun sees, thrown on the ground beneath each body.
void append_shadows(std::string& svg, const Drawing& drawing) {
  svg += "<clipPath id=\"citymesh-plate\"><path d=\"";
  append_outline(svg, outline_of(drawing.page, drawing.plate));
  // The stroke hides the seams between the shadows of neighbouring faces.
  svg +=
      "\"/></clipPath>\n<g clip-path=\"url(#citymesh-plate)\"><g fill=\"#39435c\" "
      "stroke=\"#39435c\" stroke-width=\".8\" opacity=\".34\" "
      "filter=\"url(#citymesh-soft)\">\n";
  for (const DrawnFace& face : drawing.faces) {
    if (dot(face.normal, kSun) <= 1e-6) continue;
    std::string path;
    for (const auto& ring : face.rings) {
      std::vector<Point3> fallen;
      for (const auto& corner : ring) {
        Point3 p = metres(corner);
        const double above = p.z - face.base / kGridStepsPerMetre;
        p = {p.x - above * kSun.x / kSun.z, p.y - above * kSun.y / kSun.z, p.z - above};
        fallen.push_back(to_view(p));
      }
      append_outline(path, outline_of(drawing.page, fallen));
    }
    if (path.empty()) continue;
    svg += "<path d=\"" + path + "\"/>\n";
  }
  svg += "</g></g>\n";
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
        const auto from = page.tenths(a), to = page.tenths(b);
        path += 'M';
        append_tenths(path, from[0]);
        path += ' ';
        append_tenths(path, from[1]);
        path += 'L';
        append_tenths(path, to[0]);
        path += ' ';
        append_tenths(path, to[1]);
      }
  }
  return path;
}

void append_faces(std::string& svg, const Drawing& drawing) {
  std::vector<PaintFace> faces;
  for (std::uint32_t i = 0; i < drawing.faces.size(); ++i) {
    const DrawnFace& drawn = drawing.faces[i];
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
    const DrawnFace& drawn = drawing.faces[face.paint];
    std::string path;
    if (step.triangle < 0) {
      for (const auto& ring : face.rings) append_outline(path, outline_of(drawing.page, ring));
    } else {
      append_outline(
          path, outline_of(drawing.page, face.triangles[static_cast<std::size_t>(step.triangle)]));
    }
    if (path.empty()) continue;
    svg += "<path class=\"" + class_of(drawn.rung, drawn.kind, shade_of(drawn.normal));
    if (step.triangle < 0) {
      svg += "\" d=\"" + path + "\"/>\n";
      continue;
    }
    // A piece of a face: its stroke hides the seam to the next piece, edges of the face come on
    // top.
    svg += "\" style=\"stroke-width:.9;stroke:";
    append_colour(svg, fill_of(drawn));
    svg += "\" d=\"" + path + "\"/>\n";
    const std::string edges = face_edges(drawing.page, face, step.triangle);
    if (!edges.empty())
      svg += "<path class=\"" + class_of(drawn.rung, drawn.kind, shade_of(drawn.normal)) +
             "\" style=\"fill:none\" d=\"" + edges + "\"/>\n";
  }
  svg += "</g>\n";
}

void append_north_arrow(std::string& svg, double x, double y) {
  constexpr double kRadius = 30;
  const auto on_page = [&](double east, double north) {
    const Point3 view = to_view({east * kRadius, north * kRadius, 0});
    std::string text;
    append_px(text, x + view.x);
    text += ' ';
    append_px(text, y - screen_y(view));
    return text;
  };
  svg += "<ellipse cx=\"";
  append_px(svg, x);
  svg += "\" cy=\"";
  append_px(svg, y);
  svg += "\" rx=\"30\" ry=\"18.9\" fill=\"#fff\" fill-opacity=\".7\" stroke=\"#8b94a3\"/>\n";
  svg += "<path fill=\"#2f3b52\" d=\"M" + on_page(0, 0.92) + "L" + on_page(-0.42, -0.6) + "L" +
         on_page(0, -0.25) + "z\"/>\n<path fill=\"#9aa4b5\" d=\"M" + on_page(0, 0.92) + "L" +
         on_page(0.42, -0.6) + "L" + on_page(0, -0.25) + "z\"/>\n";
  const Point3 tip = to_view({0, 1.42 * kRadius, 0});
  append_text(svg, x + tip.x, y - screen_y(tip) + 5, "n", "N");
}

void append_scale_bar(std::string& svg, double x, double y, double scale) {
  const double length = round_length(220 / scale);
  const double px = length * scale;
  for (int i = 0; i < 4; ++i) {
    svg += "<path fill=\"";
    svg += i % 2 == 0 ? "#2f3b52" : "#fff";
    svg += "\" stroke=\"#2f3b52\" stroke-width=\".8\" d=\"M";
    append_px(svg, x + i * px / 4);
    svg += ' ';
    append_px(svg, y);
    svg += 'h';
    append_px(svg, px / 4);
    svg += "v6h";
    append_px(svg, -px / 4);
    svg += "z\"/>\n";
  }
  append_text(svg, x, y - 7, "s", "0");
  std::string label;
  append_number(label, length >= 1000 ? length / 1000 : length, 3);
  append_text(svg, x + px, y - 7, "s e", label + (length >= 1000 ? " km" : " m"));
}

void append_legend(std::string& svg, const RunReport& report, double y) {
  double x = kWidth - kMargin;
  for (auto entry = report.rungs.rbegin(); entry != report.rungs.rend(); ++entry) {
    if (entry->second == 0) continue;
    const std::string label = entry->first + "\u2002" + grouped_digits(entry->second);
    x -= 8.2 * static_cast<double>(entry->first.size()) +
         9.2 * static_cast<double>(std::to_string(entry->second).size()) + 52;
    const Colour& base = rung_style(rung_index(entry->first)).colour;
    // A small cube in the light of the scene.
    const std::array<std::pair<std::string_view, Colour>, 3> sides{
        {{"l8-4.5 8 4.5-8 4.5z", shaded(base, DrawnFace::Kind::Roof, 0.75)},
         {"l8 4.5v9l-8-4.5z", shaded(base, DrawnFace::Kind::Wall, 0.05)},
         {"m8 4.5l8-4.5v9l-8 4.5z", shaded(base, DrawnFace::Kind::Wall, 0.6)}}};
    for (const auto& [path, colour] : sides) {
      svg += "<path fill=\"";
      append_colour(svg, colour);
      svg += "\" d=\"M";
      append_px(svg, x);
      svg += ' ';
      append_px(svg, y - 9);
      svg += path;
      svg += "\"/>\n";
    }
    append_text(svg, x + 23, y, "k", label);
  }
}

}  // namespace

std::string Picture::svg(const RunReport& report) const {
  std::vector<DrawnFace> faces;
  if (as_blocks_) {
    std::vector<DrawnBlock> blocks = blocks_;
    std::sort(blocks.begin(), blocks.end(),
              [](const DrawnBlock& a, const DrawnBlock& b) { return a.order < b.order; });
    for (const DrawnBlock& block : blocks)
      for (DrawnFace& face : drawn_faces(block)) faces.push_back(std::move(face));
  } else {
    faces = faces_;
  }
  const bool empty = faces.empty();
  const Drawing drawing = lay_out(std::move(faces), blocks_);

  const std::string title = report.process.empty() ? "citymesh" : report.process;
  std::string subtitle = grouped_digits(report.counts.delivered) +
                         (report.counts.delivered == 1 ? " building" : " buildings") +
                         " delivered of " + grouped_digits(report.counts.requested);
  if (!report.crs.id.empty()) subtitle += "  ·  " + report.crs.id;
  subtitle += "  ·  origin ";
  append_number(subtitle, report.origin.x, 4);
  subtitle += ", ";
  append_number(subtitle, report.origin.y, 4);
  subtitle += ", ";
  append_number(subtitle, report.origin.z, 4);
  subtitle += " m";
  if (as_blocks_) {
    subtitle += "  ·  shown as blocks";
    if (blocks_.size() < bodies_) subtitle += ", the largest " + grouped_digits(blocks_.size());
  }

  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" id=\"citymesh-picture\" viewBox=\"0 0 1400 ";
  append_px(svg, drawing.height);
  svg += "\" role=\"img\" font-family=\"system-ui,'Segoe UI',Roboto,'DejaVu Sans',sans-serif\">\n";
  svg += "<title>";
  append_markup(svg, title + ": " + subtitle);
  svg += "</title>\n";
  svg += style(drawing.faces, std::clamp(0.16 * drawing.page.scale, 0.12, 0.7));
  svg +=
      "<style>#citymesh-picture text{fill:#2f3b52}"
      "#citymesh-picture .h{font-size:25px;font-weight:600}"
      "#citymesh-picture .u{font-size:14.5px;fill:#5d687b}"
      "#citymesh-picture .k{font-size:14px}"
      "#citymesh-picture .s{font-size:12.5px}"
      "#citymesh-picture .e{text-anchor:end}"
      "#citymesh-picture .n{font-size:14px;font-weight:600;text-anchor:middle}"
      "#citymesh-picture .m{font-size:20px;text-anchor:middle;fill:#5d687b}</style>\n"
      "<defs><linearGradient id=\"citymesh-sky\" x2=\"0\" y2=\"1\"><stop "
      "stop-color=\"#f6f8fb\"/><stop offset=\"1\" stop-color=\"#e3e9f0\"/></linearGradient>"
      "<filter id=\"citymesh-soft\" x=\"-2%\" y=\"-2%\" width=\"104%\" height=\"104%\">"
      "<feGaussianBlur stdDeviation=\"";
  append_number(svg, std::clamp(0.35 * drawing.page.scale, 0.3, 2.2), 2);
  svg += "\"/></filter></defs>\n<rect width=\"1400\" height=\"";
  append_px(svg, drawing.height);
  svg += "\" fill=\"url(#citymesh-sky)\"/>\n";

  append_ground(svg, drawing);
  append_shadows(svg, drawing);
  append_faces(svg, drawing);

  append_text(svg, kMargin, 50, "h", title);
  append_text(svg, kMargin, 75, "u", subtitle);
  const double foot = drawing.height - 34;
  append_scale_bar(svg, kMargin, foot - 4, drawing.page.scale);
  append_legend(svg, report, foot + 3);
  append_north_arrow(svg, kWidth - kMargin - 40, 66);
  if (empty) append_text(svg, kWidth / 2, drawing.height / 2, "m", "No building was delivered");
  return svg + "</svg>\n";
}

}  // namespace citymesh
