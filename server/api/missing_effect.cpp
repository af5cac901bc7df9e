#include "server/api/handlers.hpp"
#include "server/api/reply.hpp"

namespace repose::server::handlers {

Reply get_comparison(Service& service, const Request& request) {
  return reply_of(service.compare(request.id, {}), 200);
}

Reply submit_diagnosis(Service& service, const Request& request) {
  return accepted(service.submit_diagnosis(request.id, request.body), "/v1/diagnoses");
}

Reply list_diagnoses(Service& service, const Request& request) {
  return reply_of(service.diagnoses(request.id), 200);
}

Reply get_diagnosis(Service& service, const Request& request) {
  return reply_of(service.diagnosis(request.id), 200);
}

Reply cancel_diagnosis(Service& service, const Request& request) {
  return reply_of(service.cancel_diagnosis(request.id), 202);
}

Reply extend_calibration(Service& service, const Request& request) {
  return accepted(service.extend(request.id, request.body), "/v1/calibrations");
}

Reply get_lineage(Service& service, const Request& request) {
  return reply_of(service.lineage(request.id), 200);
}

}  // namespace repose::server::handlers
