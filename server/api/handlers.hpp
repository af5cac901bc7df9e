/// The handlers behind the routes: each reads its request, calls the service, and prints.
#pragma once

#include "server/api/route.hpp"

namespace repose::server::handlers {

Reply submit_calibration(Service& service, const Request& request);
Reply list_calibrations(Service& service, const Request& request);
Reply get_calibration(Service& service, const Request& request);
Reply list_evaluations(Service& service, const Request& request);
Reply cancel_calibration(Service& service, const Request& request);
Reply export_fit(Service& service, const Request& request);
Reply list_best_fits(Service& service, const Request& request);

Reply follow_calibration(Service& service, const Request& request);
Reply follow_all(Service& service, const Request& request);

Reply list_measurement_sets(Service& service, const Request& request);
Reply get_measurement_set(Service& service, const Request& request);
Reply put_measurement_set(Service& service, const Request& request);
Reply list_fits(Service& service, const Request& request);
Reply get_comparison(Service& service, const Request& request);
Reply submit_diagnosis(Service& service, const Request& request);
Reply list_diagnoses(Service& service, const Request& request);
Reply get_diagnosis(Service& service, const Request& request);
Reply cancel_diagnosis(Service& service, const Request& request);
Reply extend_calibration(Service& service, const Request& request);
Reply get_lineage(Service& service, const Request& request);

Reply get_catalogue(Service& service, const Request& request);
Reply get_openapi(Service& service, const Request& request);

Reply list_materials(Service& service, const Request& request);
Reply get_material(Service& service, const Request& request);
Reply put_material(Service& service, const Request& request);
Reply remove_material(Service& service, const Request& request);

Reply add_schedule(Service& service, const Request& request);
Reply list_schedules(Service& service, const Request& request);
Reply get_schedule(Service& service, const Request& request);
Reply replace_schedule(Service& service, const Request& request);
Reply remove_schedule(Service& service, const Request& request);
Reply list_nights(Service& service, const Request& request);
Reply list_promotions(Service& service, const Request& request);
Reply promote(Service& service, const Request& request);

Reply add_webhook(Service& service, const Request& request);
Reply list_webhooks(Service& service, const Request& request);
Reply get_webhook(Service& service, const Request& request);
Reply replace_webhook(Service& service, const Request& request);
Reply remove_webhook(Service& service, const Request& request);

Reply get_health(Service& service, const Request& request);
Reply get_readiness(Service& service, const Request& request);
Reply get_metrics(Service& service, const Request& request);
Reply get_life(Service& service, const Request& request);

}  // namespace repose::server::handlers
