// The data of the report in the format that its script reads.
#include <nlohmann/json.hpp>

#include "io/page/page.hpp"

namespace talus {

namespace {

using PageJson = nlohmann::ordered_json;

constexpr int page_format = 1;

PageJson components_of(const Vec3& v) { return {v[0], v[1], v[2]}; }

/// Writes the parts of a page; blocks are referred to by their number.
class PageWriter {
 public:
  explicit PageWriter(const Page& page) : page_(page) {}

  PageJson whole() const
  {
    PageJson page{{"format", page_format},
                  {"title", page_.title},
                  {"name", page_.name},
                  {"dimension", page_.dimension},
                  {"up", components_of(page_.up)},
                  {"live", page_.live ? PageJson{{"interval", *page_.live}} : PageJson()},
                  {"summary", page_.summary.empty() ? PageJson() : PageJson::parse(page_.summary)},
                  {"scene", {{"file", page_.scene_file}, {"text", page_.scene_text}}},
                  {"warnings", list(page_.warnings)},
                  {"notes", page_.notes},
                  {"particles", of(page_.particles)},
                  {"mesh", of(page_.mesh)},
                  {"ground", of(page_.ground)},
                  {"history", of(page_.history)},
                  {"run_out", of(page_.run_out)},
                  {"metrics", list(page_.metrics)}};
    if (!page_.rigid.empty())
      page["rigid"] = list(page_.rigid);
    return page;
  }

 private:
  template <class T>
  PageJson of(const std::optional<T>& part) const
  {
    return part ? of(*part) : PageJson();
  }
  template <class T>
  PageJson list(const std::vector<T>& parts) const
  {
    PageJson all = PageJson::array();
    for (const T& part : parts)
      all.push_back(of(part));
    return all;
  }
  PageJson block(BlockId id) const
  {
    const PageBlock& b = page_.blocks.at(id);
    return {{"id", id}, {"count", b.count}, {"type", b.type}, {"delta", b.delta}, {"planes", b.planes}};
  }
  PageJson block(const std::optional<BlockId>& id) const { return id ? block(*id) : PageJson(); }
  void add(const PagePlaces& x, PageJson& object) const
  {
    object["low"] = components_of(x.low);
    object["high"] = components_of(x.high);
    object["x"] = block(x.axes.at(0));
    object["y"] = block(x.axes.at(1));
    object["z"] = x.axes.size() > 2 ? block(x.axes[2]) : PageJson();
  }

  static PageJson of(const PageWarning& warning)
  {
    PageJson object{{"text", warning.text}};
    if (warning.line)
      object["line"] = *warning.line;
    return object;
  }
  static PageJson of(const PageBody& body) { return {{"name", body.name}, {"material", body.material}, {"law", body.law}}; }
  static PageJson of(const PageField& field)
  {
    return {{"name", field.name}, {"label", field.label}, {"unit", field.unit}, {"low", field.low}, {"high", field.high}};
  }
  static PageJson of(const PageMetric& metric)
  {
    return {{"group", metric.group}, {"name", metric.name}, {"value", metric.value}, {"unit", metric.unit}, {"note", metric.note}};
  }
  static PageJson of(const CsvColumn& column) { return {{"name", column.name}, {"unit", column.unit}}; }
  PageJson of(const PageFrame& frame) const
  {
    PageJson object{{"time", frame.time}, {"count", frame.count}};
    add(frame.x, object);
    object["id"] = block(frame.ids);
    object["body"] = block(frame.body);
    object["growth"] = block(frame.growth);
    object["fields"] = PageJson::array();
    for (const std::optional<BlockId>& field : frame.fields)
      object["fields"].push_back(block(field));
    if (!page_.rigid.empty())
      object["rigid"] = block(frame.rigid);
    return object;
  }
  PageJson of(const PageParticles& particles) const
  {
    return {{"total", particles.total},
            {"shown", particles.shown},
            {"radius", particles.radius},
            {"bodies", list(particles.bodies)},
            {"fields", list(particles.fields)},
            {"field", 0},
            {"range", particles.range ? PageJson(*particles.range) : PageJson()},
            {"frames", list(particles.frames)}};
  }
  PageJson of(const PageMesh& mesh) const
  {
    PageJson object{{"count", mesh.nodes}};
    add(mesh.x, object);
    object["outline"] = block(mesh.outline);
    object["cells"] = block(mesh.cells);
    return object;
  }
  PageJson of(const PageGround& ground) const
  {
    PageJson object{{"count", ground.nodes}};
    add(ground.x, object);
    object["rigid"] = block(ground.rigid);
    object["layers"] = block(ground.layers);
    return object;
  }
  PageJson of(const PageRigid& body) const
  {
    PageJson object{{"name", body.name}, {"count", body.nodes}};
    add(body.x, object);
    object["triangles"] = block(body.triangles);
    return object;
  }
  PageJson of(const PageTable& table) const
  {
    return {{"columns", list(table.columns)}, {"rows", table.rows}, {"thinned", table.thinned}, {"values", block(table.values)}};
  }

  const Page& page_;
};

}  // namespace

std::string to_json(const Page& page) { return PageWriter(page).whole().dump(-1, ' ', false, PageJson::error_handler_t::replace); }

}  // namespace talus
