-- Which schedule, and which of its nights, an event is of.
ALTER TABLE event ADD COLUMN schedule_id INTEGER REFERENCES schedule (id);
ALTER TABLE event ADD COLUMN night_id INTEGER REFERENCES night (id);

DROP TRIGGER night_ends;
CREATE TRIGGER night_ends AFTER UPDATE OF state ON night
WHEN new.state <> old.state
BEGIN
  INSERT INTO event (kind, schedule_id, night_id, calibration_id, diagnosis_id, detail)
  VALUES ('night.' || coalesce(new.outcome, new.state), new.schedule_id, new.id,
          new.calibration_id, new.diagnosis_id, new.result);
END;

DROP TRIGGER night_alarms;
CREATE TRIGGER night_alarms AFTER UPDATE OF state ON night
WHEN new.state <> old.state AND instr(new.result, '"alarms":[') > 0
  AND instr(new.result, '"alarms":[]') = 0
BEGIN
  INSERT INTO event (kind, schedule_id, night_id, calibration_id, detail)
  VALUES ('night.drift', new.schedule_id, new.id, new.calibration_id, new.result);
END;

DROP TRIGGER promotion_begins;
CREATE TRIGGER promotion_begins AFTER INSERT ON promotion
BEGIN
  INSERT INTO event (kind, schedule_id, night_id, calibration_id)
  VALUES ('promotion', new.schedule_id, new.night_id, new.calibration_id);
END;
