//! Table columns as Arrow arrays; numbers are not copied.

use std::sync::Arc;

use arrow_array::types::{Float32Type, Float64Type, TimestampNanosecondType, UInt32Type, UInt64Type};
use arrow_array::{ArrayRef, ArrowPrimitiveType, BooleanArray, PrimitiveArray, RecordBatch, StringArray};
use arrow_schema::{DataType, Field, Schema, SchemaRef, TimeUnit};
use boresight::files::{Cells, Column, ColumnType, ColumnValues, Nanoseconds};
use pyo3::prelude::*;

use crate::errors::BoresightError;

/// Time zone of all times.
const ZONE: &str = "UTC";

/// Returns the Arrow schema of columns: their names and types.
pub(crate) fn schema(columns: &[Column]) -> SchemaRef {
    let field = |column: &Column| {
        Field::new(column.name(), data_type(column.values().column_type()), column.is_nullable())
    };
    Arc::new(Schema::new(columns.iter().map(field).collect::<Vec<_>>()))
}

/// Combines columns of equal length into a record batch.
pub(crate) fn batch(columns: Vec<Column>) -> PyResult<RecordBatch> {
    let schema = schema(&columns);
    let arrays = columns.into_iter().map(|column| array(column.into_values())).collect();
    RecordBatch::try_new(schema, arrays).map_err(|error| BoresightError::new_err(error.to_string()))
}

fn data_type(column_type: ColumnType) -> DataType {
    match column_type {
        ColumnType::Boolean => DataType::Boolean,
        ColumnType::UInt32 => DataType::UInt32,
        ColumnType::UInt64 => DataType::UInt64,
        ColumnType::Float32 => DataType::Float32,
        ColumnType::Float64 => DataType::Float64,
        ColumnType::Timestamp => DataType::Timestamp(TimeUnit::Nanosecond, Some(ZONE.into())),
        ColumnType::Utf8 => DataType::Utf8,
    }
}

fn array(values: ColumnValues) -> ArrayRef {
    match values {
        ColumnValues::Boolean(cells) => {
            let (values, is_valid) = cells.into_parts();
            Arc::new(BooleanArray::new(values.into(), is_valid.map(Into::into)))
        }
        ColumnValues::UInt32(cells) => Arc::new(numbers::<UInt32Type>(cells)),
        ColumnValues::UInt64(cells) => Arc::new(numbers::<UInt64Type>(cells)),
        ColumnValues::Float32(cells) => Arc::new(numbers::<Float32Type>(cells)),
        ColumnValues::Float64(cells) => Arc::new(numbers::<Float64Type>(cells)),
        ColumnValues::Timestamp(cells) => {
            let (values, is_valid) = cells.into_parts();
            let values: Vec<i64> = values.into_iter().map(|Nanoseconds(value)| value).collect();
            let times =
                PrimitiveArray::<TimestampNanosecondType>::new(values.into(), is_valid.map(Into::into));
            Arc::new(times.with_timezone(ZONE))
        }
        ColumnValues::Utf8(texts) => Arc::new(StringArray::from_iter(texts.iter())),
    }
}

fn numbers<T: ArrowPrimitiveType>(cells: Cells<T::Native>) -> PrimitiveArray<T> {
    let (values, is_valid) = cells.into_parts();
    PrimitiveArray::new(values.into(), is_valid.map(Into::into))
}
