-- A night to which nothing had changed said that the fit in force was kept, also where none was, or
-- where it had failed. A check cannot be altered: the table is made again, with all of its rows.
CREATE TABLE night_anew (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  schedule_id INTEGER NOT NULL REFERENCES schedule (id),
  planned_at INTEGER NOT NULL,
  started_at INTEGER NOT NULL,
  finished_at INTEGER,
  state TEXT NOT NULL CHECK (state IN ('running', 'done', 'failed', 'skipped')),
  outcome TEXT CHECK (outcome IN ('first', 'kept', 'moved', 'model_no_longer_adequate',
    'unchanged')),
  incumbent_id INTEGER REFERENCES calibration (id),
  calibration_id INTEGER REFERENCES calibration (id),
  continues TEXT,
  diagnosis_id INTEGER REFERENCES diagnosis (id),
  result TEXT,
  UNIQUE (schedule_id, planned_at),
  CHECK ((finished_at IS NULL) = (state = 'running')),
  CHECK ((outcome IS NULL) = (state <> 'done'))
) STRICT;

INSERT INTO night_anew (id, schedule_id, planned_at, started_at, finished_at, state, outcome,
  incumbent_id, calibration_id, continues, diagnosis_id, result)
SELECT id, schedule_id, planned_at, started_at, finished_at, state, outcome, incumbent_id,
  calibration_id, continues, diagnosis_id, result
FROM night ORDER BY id;

DROP TABLE night;
ALTER TABLE night_anew RENAME TO night;

CREATE INDEX night_by_calibration ON night (calibration_id);

CREATE TRIGGER night_final BEFORE UPDATE ON night
WHEN old.state <> 'running'
BEGIN
  SELECT RAISE(ABORT, 'a finished night does not change');
END;

CREATE TRIGGER night_ends AFTER UPDATE OF state ON night
WHEN new.state <> old.state
BEGIN
  INSERT INTO event (kind, schedule_id, night_id, calibration_id, diagnosis_id, detail)
  VALUES ('night.' || coalesce(new.outcome, new.state), new.schedule_id, new.id,
          new.calibration_id, new.diagnosis_id, new.result);
END;

CREATE TRIGGER night_alarms AFTER UPDATE OF state ON night
WHEN new.state <> old.state AND instr(new.result, '"alarms":[') > 0
  AND instr(new.result, '"alarms":[]') = 0
BEGIN
  INSERT INTO event (kind, schedule_id, night_id, calibration_id, detail)
  VALUES ('night.drift', new.schedule_id, new.id, new.calibration_id, new.result);
END;
