#include "core/write/picture.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/write/drawing.h"
#include "core/write/html.h"
#include "core/write/painter.h"
#include "core/write/text.h"

namespace citymesh {
namespace {

constexpr std::string_view kOnlyChecks = "validate";
constexpr double kWidth = 1400;
constexpr double kMargin = 40;
constexpr double kTitleHeight = 96;
constexpr double kFooterHeight = 84;
constexpr double kMinScene = 420, kMaxScene = 900;  // height of the scene

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
  above.reserve(feet.size());
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
    append_segment(svg, page.tenths(to_view({x1, y1, drawing.ground.at(x1, y1)})),
                   page.tenths(to_view({x2, y2, drawing.ground.at(x2, y2)})));
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

struct LegendEntry {
  std::string name{};
  std::uint64_t count = 0;
  Colour colour{};
};

void append_legend(std::string& svg, const std::vector<LegendEntry>& entries, double y) {
  double x = kWidth - kMargin;
  for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry) {
    if (entry->count == 0) continue;
    const std::string label = entry->name + "\u2002" + grouped(entry->count);
    x -= 8.2 * static_cast<double>(entry->name.size()) +
         9.2 * static_cast<double>(std::to_string(entry->count).size()) + 52;
    // A small cube in the light of the scene.
    const std::array<std::pair<std::string_view, Colour>, 3> sides{
        {{"l8-4.5 8 4.5-8 4.5z", shaded(entry->colour, DrawnFace::Kind::Roof, 0.75)},
         {"l8 4.5v9l-8-4.5z", shaded(entry->colour, DrawnFace::Kind::Wall, 0.05)},
         {"m8 4.5l8-4.5v9l-8 4.5z", shaded(entry->colour, DrawnFace::Kind::Wall, 0.6)}}};
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

/// Where the defects are, on top of everything.
void append_marks(std::string& svg, const Page& page, const std::vector<Point3>& marks) {
  if (marks.empty()) return;
  constexpr std::int64_t kApart_tenths = 40;  // nearer ones are one mark
  std::set<std::array<std::int64_t, 2>> places;
  std::string radius;
  append_px(radius, std::clamp(0.5 * page.scale, 2.0, 5.0));
  svg += "<g fill=\"#c8102e\" fill-opacity=\".8\" stroke=\"#fff\" stroke-width=\".8\">\n";
  for (const Point3& mark : marks) {
    const auto at = page.tenths(to_view(mark));
    if (!places.insert({at[0] / kApart_tenths, at[1] / kApart_tenths}).second) continue;
    svg += "<circle cx=\"";
    append_tenths(svg, at[0]);
    svg += "\" cy=\"";
    append_tenths(svg, at[1]);
    svg += "\" r=\"" + radius + "\"/>\n";
  }
  svg += "</g>\n";
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
  std::vector<LegendEntry> legend;
  std::string subtitle;
  if (report.process == kOnlyChecks) {
    subtitle = plural(report.counts.requested, "building", "buildings") + " checked";
    for (std::size_t i = 0; i < sources_.size(); ++i)
      legend.push_back({std::string(kStyles[i].meaning), sources_[i], kStyles[i].colour});
  } else {
    subtitle = plural(report.counts.delivered, "building", "buildings") + " delivered of " +
               grouped(report.counts.requested);
    for (const auto& [rung, count] : report.rungs)
      legend.push_back({rung, count, kStyles[rung_style(rung)].colour});
  }
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
    if (blocks_.size() < bodies_) subtitle += ", the largest " + grouped(blocks_.size());
  }

  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" id=\"citymesh-picture\" viewBox=\"0 0 1400 ";
  append_px(svg, drawing.height);
  svg += "\" role=\"img\" font-family=\"system-ui,'Segoe UI',Roboto,'DejaVu Sans',sans-serif\">\n";
  svg += "<title>";
  append_markup(svg, title + ": " + subtitle);
  svg += "</title>\n";
  Looks looks;
  looks.add(drawing.faces);
  svg += "<style>" +
         looks.css("#citymesh-picture", std::clamp(0.16 * drawing.page.scale, 0.12, 0.7)) +
         "</style>\n";
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
  append_faces(svg, drawing.page, drawing.faces);
  append_marks(svg, drawing.page, marks_);

  append_text(svg, kMargin, 50, "h", title);
  append_text(svg, kMargin, 75, "u", subtitle);
  const double foot = drawing.height - 34;
  append_scale_bar(svg, kMargin, foot - 4, drawing.page.scale);
  append_legend(svg, legend, foot + 3);
  append_north_arrow(svg, kWidth - kMargin - 40, 66);
  if (empty)
    append_text(
        svg, kWidth / 2, drawing.height / 2, "m",
        report.process == kOnlyChecks ? "There is nothing to see" : "No building was delivered");
  return svg + "</svg>\n";
}

}  // namespace citymesh
