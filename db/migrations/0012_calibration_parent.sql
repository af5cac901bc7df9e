-- The calibration that another one extends, as its request has it: beside it, to find the others by.
-- It may be of another database, so it refers to no row.
ALTER TABLE calibration ADD COLUMN parent_id INTEGER;

DROP TRIGGER calibration_final;
UPDATE calibration SET parent_id = json_extract(request, '$.extends.calibration')
WHERE json_valid(request) AND json_extract(request, '$.extends.calibration') IS NOT NULL;
CREATE TRIGGER calibration_final BEFORE UPDATE ON calibration
WHEN old.state IN ('done', 'failed', 'cancelled')
BEGIN
  SELECT RAISE(ABORT, 'a finished calibration does not change');
END;

CREATE INDEX calibration_by_parent ON calibration (parent_id, id) WHERE parent_id IS NOT NULL;
