-- Calibrations that are repeated by the clock. Every night is a row, whatever came of it; which fit
-- users get is the last promotion of the schedule.
CREATE TABLE schedule (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  name TEXT NOT NULL,
  created_at INTEGER NOT NULL,
  replaced_at INTEGER,
  removed_at INTEGER,
  request TEXT NOT NULL
) STRICT;

CREATE TABLE night (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  schedule_id INTEGER NOT NULL REFERENCES schedule (id),
  planned_at INTEGER NOT NULL,
  started_at INTEGER NOT NULL,
  finished_at INTEGER,
  state TEXT NOT NULL CHECK (state IN ('running', 'done', 'failed', 'skipped')),
  outcome TEXT CHECK (outcome IN ('first', 'kept', 'moved', 'model_no_longer_adequate')),
  incumbent_id INTEGER REFERENCES calibration (id),
  calibration_id INTEGER REFERENCES calibration (id),
  continues TEXT,
  diagnosis_id INTEGER REFERENCES diagnosis (id),
  result TEXT,
  UNIQUE (schedule_id, planned_at),
  CHECK ((finished_at IS NULL) = (state = 'running')),
  CHECK ((outcome IS NULL) = (state <> 'done'))
) STRICT;

CREATE INDEX night_by_calibration ON night (calibration_id);

CREATE TRIGGER night_final BEFORE UPDATE ON night
WHEN old.state <> 'running'
BEGIN
  SELECT RAISE(ABORT, 'a finished night does not change');
END;

CREATE TABLE promotion (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  schedule_id INTEGER NOT NULL REFERENCES schedule (id),
  calibration_id INTEGER NOT NULL REFERENCES calibration (id),
  night_id INTEGER REFERENCES night (id),
  promoted_at INTEGER NOT NULL,
  reason TEXT NOT NULL
) STRICT;

CREATE INDEX promotion_by_schedule ON promotion (schedule_id, id);

CREATE TRIGGER promotion_final BEFORE UPDATE ON promotion
BEGIN
  SELECT RAISE(ABORT, 'a promotion does not change');
END;

-- What nights come to is told to those who follow events; so is a quantity that drifts.
CREATE TRIGGER night_ends AFTER UPDATE OF state ON night
WHEN new.state <> old.state
BEGIN
  INSERT INTO event (kind, calibration_id, diagnosis_id, detail)
  VALUES ('night.' || coalesce(new.outcome, new.state), new.calibration_id, new.diagnosis_id,
          new.result);
END;

CREATE TRIGGER night_alarms AFTER UPDATE OF state ON night
WHEN new.state <> old.state AND instr(new.result, '"alarms":[') > 0
  AND instr(new.result, '"alarms":[]') = 0
BEGIN
  INSERT INTO event (kind, calibration_id, detail)
  VALUES ('night.drift', new.calibration_id, new.result);
END;

CREATE TRIGGER promotion_begins AFTER INSERT ON promotion
BEGIN
  INSERT INTO event (kind, calibration_id, detail)
  VALUES ('promotion', new.calibration_id, '{"schedule":' || new.schedule_id || '}');
END;
